//! Tests of the command as its users run it.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod axes;
mod batch;
#[cfg(target_os = "linux")]
mod between;
mod bounds;
mod bowls;
mod browser;
mod calibrate;
mod ceilings;
mod changes;
mod channels;
mod check;
mod check_posts;
mod clear_choice;
mod clearance;
mod command;
mod common;
mod compensate;
mod convert;
mod course;
mod cut_stock;
mod cycle_time;
mod dependencies;
mod dialects;
mod diff;
mod drives;
mod face;
mod files;
mod frame;
mod fuzzed;
mod guide;
mod guides;
mod held_alike;
mod hole_bounds;
mod job_file;
mod jobs;
mod joined_files;
mod languages;
#[cfg(target_os = "linux")]
mod leaning_axes;
mod lengths;
mod library;
mod lingering;
mod lint;
mod linuxcnc;
mod lsp;
#[cfg(target_os = "linux")]
mod machine_messages;
mod memory;
mod messages;
mod mutations;
mod names;
mod new;
mod order;
mod orientation;
mod part_place;
mod place;
mod plan_rounds;
mod plan_shown;
mod plan_worth;
mod plugins;
mod point_lists;
mod predict;
mod predict_measured;
mod predict_numbers;
mod predict_told;
mod printers;
mod program_text;
mod random_links;
mod rapids;
mod rapids_beside;
mod readiness;
mod real_files;
mod report;
mod report_page;
mod report_solids;
mod right_jobs;
#[cfg(unix)]
mod rights;
mod robot_programs;
mod robots;
mod rotary_way;
mod settings;
mod several_stocks;
mod shells;
#[cfg(unix)]
mod signals;
mod snapshots;
mod splines;
mod strangers;
mod summary;
mod terminal;
mod threads;
mod tools;
mod turning;
mod unsaid;
mod verbs;
mod verified;
mod vocabularies;
mod ways_across;
mod words;
mod wrap;
mod writable;
mod wrong_programs;
mod wrong_words;

#[path = "../bench/common/peak.rs"]
#[cfg(target_os = "linux")]
mod peak;

#[path = "../bench/generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;
