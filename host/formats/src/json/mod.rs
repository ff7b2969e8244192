//! JSON: documents, among them those of SysId, and JSON lines.
//!
//! | file | holds |
//! |---|---|
//! | `begin` | which of them a file is |
//! | `lenient` | JSON as Python writes it |
//! | `cells` | a value taken apart into single values with paths |
//! | `schema` | the columns of rows that each have names of their own |
//! | `frame` | a list as columns |
//! | `node` | a document as a tree |
//! | `sysid` | files of WPILib's SysId |
//! | `tables` | the tables of a document |
//! | `document` | the log of a document |
//! | `lines` | the log of a file of lines |
//! | `fault` | what an error of serde means |

mod begin;
mod cells;
mod document;
mod fault;
mod frame;
mod lenient;
mod lines;
mod node;
mod schema;
mod sysid;
mod tables;

pub(crate) use begin::format_of;
pub(crate) use document::open as open_document;
pub(crate) use lines::open as open_lines;
