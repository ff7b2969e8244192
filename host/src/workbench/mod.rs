//! The workbench: a page on the loopback address on which a recording is fitted, the model compared with it, what is
//! missing added, and the result taken away.
//!
//! | file | holds |
//! |---|---|
//! | `loaded` | a recording as it came, and as it is fitted |
//! | `blind` | recordings of a motor in which something is hidden |
//! | `recordings` | which recordings are fitted, which judge, and over which span |
//! | `model` | a fitted model on the bench |
//! | `state` | the bench's state, and its change notifications to the page |
//! | `job` | one piece of work at a time, which stops when nobody watches |
//! | `work` | the pieces of work: fit, suggest, diagnose, race |
//! | `device` | a device that is connected, its limits, and its run that is under way |
//! | `driven`, `planned` | work that drives its motor, and the experiment that decides |
//! | `live` | what the page draws of a run |
//! | `dropped`, `intake` | files that wait to be read, and what their columns may be |
//! | `shown`, `proposals`, `sliders` | what the page says |
//! | `series`, `failing`, `details`, `drawings` | what it draws: lanes, where models fail, tabs, each made once |
//! | `remedy` | a speed loop with and without what is known of the effects |
//! | `catalogue` | every effect's signature |
//! | `files` | the files of the page |
//! | `session_file` | the bench as a file |
//! | `download` | what may be taken away as a file |
//! | `words` | what was written for a terminal, in the words of a page |
//! | `routes`, `guard` | what the page may ask, and who may ask |
//! | `opened`, `begun`, `answer` | what it puts on the bench, the work that it begins, and how it is answered |
//! | `history` | undo and redo |
//! | `lock` | one program on a session at a time |
//! | `server` | listening and stopping |

mod answer;
mod begun;
mod blind;
mod catalogue;
mod details;
mod device;
mod download;
mod drawings;
mod driven;
mod dropped;
mod failing;
mod files;
mod guard;
mod history;
mod intake;
mod job;
mod law;
mod live;
mod loaded;
mod lock;
mod model;
mod opened;
mod planned;
mod proposals;
mod recordings;
mod remedy;
mod routes;
mod series;
mod server;
mod session_file;
mod shown;
mod sliders;
mod state;
mod words;
mod work;

pub use device::Device;
pub use intake::read;
pub use loaded::{Loaded, Source};
pub use server::{Opening, Server};
pub use session_file::{FAMILY, SessionFile};
