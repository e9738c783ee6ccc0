//! Words that several controls of the family read alike, in groups, for [`crate::Table::words`].
//!
//! No dialect here writes them; programs of others hold them.

use post_plugin::Meaning;

/// Reference positions.
pub const RETURNS: &[(&str, Meaning)] =
    &[("G28", Meaning::ReferenceReturn), ("G30", Meaning::OtherReferenceReturn)];

/// What words count from: the zero shifted, the position called something else, tables of the control.
pub const SHIFTS: &[(&str, Meaning)] =
    &[("G52", Meaning::LocalOffset), ("G92", Meaning::SetPosition), ("G10", Meaning::TableData)];

/// Coordinates that are turned, multiplied or mirrored.
pub const FRAMES: &[(&str, Meaning)] = &[
    ("G68", Meaning::Rotation),
    ("G51", Meaning::Scale),
    ("G50", Meaning::ScaleOff),
    ("G51.1", Meaning::Mirror),
    ("G50.1", Meaning::MirrorOff),
    ("G50.1", Meaning::OwnAxisWords),
];

/// Areas that the axes keep out of.
pub const AREAS: &[(&str, Meaning)] =
    &[("G22", Meaning::OwnAxisWords), ("G23", Meaning::NoAxisWords)];

/// Coordinates that are no positions of linear axes.
pub const POLAR: &[(&str, Meaning)] = &[
    ("G16", Meaning::Polar),
    ("G15", Meaning::PolarOff),
    ("G12.1", Meaning::FaceTransformation),
    ("G112", Meaning::FaceTransformation),
    ("G13.1", Meaning::FaceTransformationOff),
    ("G113", Meaning::FaceTransformationOff),
    ("G7.1", Meaning::CylinderTransformation),
    ("G107", Meaning::CylinderTransformation),
];

/// How closely the path is kept: stops at the ends of blocks, and none.
pub const STOPS: &[(&str, Meaning)] =
    &[("G9", Meaning::ExactStop), ("G61", Meaning::SmoothingOff), ("G64", Meaning::Smoothing)];

/// The end of a subprogram.
pub const SUBPROGRAM_END: &[(&str, Meaning)] = &[("M99", Meaning::SubprogramEnd)];
