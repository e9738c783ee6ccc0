//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

mod cl_source;
mod cl_window;
mod gauges;
mod grid;
mod memory_disk;
mod one_job;
mod read_ahead;
mod solids;

#[path = "../../../src/files/abandoned.rs"]
mod abandoned;
#[path = "../../../src/beside.rs"]
mod beside;
#[path = "../../../src/report/branch.rs"]
mod branch;
#[path = "../../../src/predict/measured/clock.rs"]
mod clock;
#[path = "../../../src/disk/memory.rs"]
mod disk_in_memory;
#[path = "../../../src/files/chart/envelope.rs"]
mod envelope;
#[path = "../../../src/plan_rounds/excess.rs"]
mod excess;
#[path = "../../../src/files/file_id.rs"]
mod file_id;
#[path = "../../../src/files/naming.rs"]
mod naming;
#[path = "../../../src/files/outcome.rs"]
mod outcome;
#[path = "../../../src/files/parquet.rs"]
mod parquet;
#[path = "../../../src/files/scale.rs"]
mod scale;
#[path = "../../../src/predict/pictures/spectrum.rs"]
mod spectrum;
#[path = "../../../src/files/svg.rs"]
mod svg;
#[path = "../../../src/files/temporary.rs"]
mod temporary;

use post_job::disk;
