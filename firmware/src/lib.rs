//! The board-independent application. The boards themselves are still to come.
#![cfg_attr(target_os = "none", no_std)]
#![forbid(unsafe_code)]
