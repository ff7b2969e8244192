//! Laws of the library, each over a list: of recordings, effects, motors, drawn cases. One program, since each links the whole host.
#![forbid(unsafe_code)]

mod bad_motor_files;
mod bad_recordings;
mod certificates;
mod compressed;
mod drawn_diagnoses;
mod effects_match_bench;
mod gearboxes;
mod integration;
mod lanes;
mod likelihoods;
mod no_text;
mod one_recording;
mod paper_contest;
mod plans;
mod position_drives;
mod quick_costs;
mod reader_laws;
mod signatures;
mod threads;
mod unexcited_recordings;
mod vendored;
mod whole_files;
