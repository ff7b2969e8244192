//! Journeys of users through the compiled `servoid`: what they type, and all that they can see of it,
//! which is the exit code, both output streams, and the files in their folder.
#![forbid(unsafe_code)]

mod accuracy;
mod bad_flags;
mod bad_outputs;
mod bad_recordings;
mod batch;
mod bench;
mod certificate;
mod check;
mod colour;
mod compare_apart;
mod contract;
mod desk;
mod device_signals;
mod diagnose;
mod diagnose_pairs;
mod export;
mod fleet;
mod foreign_logs;
mod formulas;
mod glitches;
mod help_examples;
mod interrupt;
mod known_facts;
mod likelihoods;
mod main_job;
mod open;
mod open_plot;
mod paper;
mod pipes;
mod plan;
mod position;
mod processors;
mod prove;
mod ranges;
mod repeatable;
mod report;
mod searches;
mod several;
mod simulate;
mod width;
