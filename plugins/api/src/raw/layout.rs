//! Where the fields of the shared structs stand.

use std::mem::{align_of, offset_of, size_of};

use super::{
    PostAxisWord, PostDialect, PostEvent, PostFormat, PostModel, PostOption, PostPair, PostPlugin,
    PostSetup, PostSink, PostText, PostTool, PostValue,
};
use crate::{Curve, Deviation, Tolerance};

/// Size, alignment and fields of a shared struct, as the C header must have them.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Name of the struct in C.
    pub name: &'static str,
    /// Bytes.
    pub size: usize,
    /// Bytes.
    pub align: usize,
    /// Name and offset of each field.
    pub fields: &'static [(&'static str, usize)],
}

macro_rules! layouts {
    ($($type:ident as $name:literal { $($field:ident)* })*) => {
        &[$(Layout {
            name: $name,
            size: size_of::<$type>(),
            align: align_of::<$type>(),
            fields: &[$((stringify!($field), offset_of!($type, $field))),*],
        }),*]
    };
}

/// The data that is shared. A change here is a new [`ABI`](super::ABI).
pub const LAYOUTS: &[Layout] = layouts! {
    PostText as "PostText" { ptr len }
    PostSink as "PostSink" { ctx write }
    PostValue as "PostValue" { kind reserved integer number text }
    PostPair as "PostPair" { key value }
    PostOption as "PostOption" { key help kind reserved min max default_value choices choices_len }
    PostAxisWord as "PostAxisWord" { name rotary depth carries_part reserved least largest }
    PostTool as "PostTool" { name number reserved length diameter corner_radius }
    PostEvent as "PostEvent" { kind texts_len line numbers numbers_len texts }
    Deviation as "PostDeviation" { tip axis }
    Tolerance as "PostTolerance" { tip axis }
    Curve as "PostCurve" { tip_peak tip_at axis_peak axis_at terms }
};

/// Tables of functions, and structs that say how long they are. They may grow at their end, so they are not part
/// of [`LAYOUT`].
pub const TABLES: &[Layout] = layouts! {
    PostSetup as "PostSetup" {
        size program machine units tcp words words_len options options_len
        cl_file tip_tolerance axis_tolerance rapid_tolerance ahead moves tools tools_len least largest time
        turns_part diameters
    }
    PostFormat as "PostFormat" {
        size words feed inverse_time feed_per_revolution words_len extension writes most_inverse_time
        plane_angles plane_decimals language reserved rapid_feed
    }
    PostPlugin as "PostPlugin" {
        magic abi kind size table_size layout name version describe loaded dialect model about
    }
    PostDialect as "PostDialect" { open format write last_error close vocabulary relies_on }
    PostModel as "PostModel" { open fit value last_error close }
};

/// Hash over size, alignment and offsets of the shared data: catches a plugin that was built against
/// another header, or for another kind of machine.
pub const LAYOUT: u64 = {
    // FNV-1a, a number at a time: its only use is to differ when a number does.
    const fn mix(hash: u64, value: usize) -> u64 {
        (hash ^ value as u64).wrapping_mul(0x0000_0100_0000_01b3)
    }
    let mut hash = 0xcbf2_9ce4_8422_2325;
    let mut index = 0;
    while index < LAYOUTS.len() {
        let layout = LAYOUTS[index];
        hash = mix(mix(hash, layout.size), layout.align);
        let mut field = 0;
        while field < layout.fields.len() {
            hash = mix(hash, layout.fields[field].1);
            field += 1;
        }
        index += 1;
    }
    hash
};
