//! How far tools reach from their axes: holder and cutter as profiles of revolution.

use serde_json::json;

use super::bounds::Bounds;
use super::build::Builder;
use super::quantity::KeyedNumber;
use super::table::{
    DeValue, EntryError, Key, KeyType, Schemas, Slip, Spanned, Value, keys, of_another_kind,
};
use super::turned::{NoArc, TurnedProfile};
use crate::diagnostic::Short;

const EDGE: Bounds = Bounds { says: " mm", ..Bounds::above_zero("machine-body") };

const NOSE: Bounds = Bounds { says: " mm", ..Bounds::from_zero("machine-tools") };

keys! {
    /// A tool: its length, and how far it reaches from its axis.
    ToolOutlineFile {
        /// From the gauge point to the tip, mm.
        length: Option<KeyedNumber>,
        /// What does not cut, as a profile of revolution: points [z, r], z in mm from the gauge point towards the tip, r in
        /// mm from the axis. What is between two points is a cone; `[z, r, { arc = R }]` comes there on an arc of this radius,
        /// mm: it bulges outwards, and with R below zero it is hollow.
        holder: Vec<ProfilePoint>,
        /// What cuts, likewise, z in mm from the tip towards the gauge point.
        cutter: Vec<ProfilePoint>,
        /// How far its edges go up from the tip, mm; what of the cutter is above them is a shank, and may touch no stock. All
        /// of the cutter cuts if not said.
        edge: Option<KeyedNumber> = EDGE,
        /// Radius of a turning tool's nose, mm, for `[cl] points`.
        nose: Option<KeyedNumber> = NOSE,
        /// Where its imaginary tip lies from the centre of its nose, as Fanuc, Haas and Siemens number it: 1 X+ Z+, 2 X+ Z-
        /// (turned inside), 3 X- Z- (turned outside, towards the chuck), 4 X- Z+, 5 Z+, 6 X+, 7 Z-, 8 X- (grooved), 9 in it.
        quadrant: Option<Spanned<u32>> = Bounds::within(1.0, 9.0, "", ""),
    }

    /// How a profile comes to a point.
    ProfileWayFile {
        /// Radius of the arc from the point before, mm, the shorter one: above zero it bulges outwards, below it is hollow.
        arc: KeyedNumber,
    }
}

/// A point of a profile, `[z, r]`, or `[z, r, { arc = R }]`.
#[derive(Debug)]
pub(crate) struct ProfilePoint {
    z: KeyedNumber,
    r: KeyedNumber,
    way: Option<ProfileWayFile>,
}

impl KeyType for ProfilePoint {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let items = match value.get_ref() {
            DeValue::Array(items) if (2..=3).contains(&items.len()) => items,
            DeValue::Array(items) => {
                let message = format!("a point of {} things, expected [z, r]", items.len());
                return Err(EntryError { span: value.span(), slip: Slip::Kind(message) });
            }
            _ => return Err(of_another_kind(value, "a point [z, r], or [z, r, { arc = R }]")),
        };
        let way = items.get(2).map(|way| ProfileWayFile::read(way, key)).transpose()?;
        let [z, r] = [&items[0], &items[1]].map(|number| KeyedNumber::read(number, key));
        Ok(Self { z: z?, r: r?, way })
    }

    fn schema(named: &mut Schemas) -> Value {
        let number = KeyedNumber::schema(named);
        let way = ProfileWayFile::schema(named);
        json!({ "type": "array", "items": [number, number, way], "minItems": 2, "maxItems": 3 })
    }
}

/// How far a tool reaches from its axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolOutline {
    /// Its number.
    pub number: u32,
    /// What does not cut, z from the gauge point towards the tip.
    pub holder: TurnedProfile,
    /// What cuts, z from the tip towards the gauge point.
    pub cutter: TurnedProfile,
    /// How far its edges go up from the tip, mm; all of the cutter if not said.
    pub edge: Option<f64>,
}

impl Builder<'_> {
    /// The profile of a cutter: it begins at the tip.
    pub(super) fn cutter(&mut self, what: &str, points: &[ProfilePoint]) -> TurnedProfile {
        let profile = self.turned(what, points);
        if let ([first, ..], Some([begins, _])) = (points, profile.points.first())
            && *begins != 0.0
        {
            let (way, side) =
                (Short(libm::fabs(*begins)), if *begins > 0.0 { "above" } else { "below" });
            let message = format!("{what} begins {way} mm {side} its tip");
            let help = "z counts from the tip up: the first point is [0, r]";
            self.fault("machine-body", first.z.span(), message, help);
        }
        profile
    }

    /// The profile of a holder: it goes down from the gauge point.
    pub(super) fn holder(&mut self, what: &str, points: &[ProfilePoint]) -> TurnedProfile {
        let profile = self.turned(what, points);
        if let ([.., last], Some([ends, _])) = (points, profile.points.last())
            && *ends <= 0.0
        {
            let message = format!(
                "{what} ends at z = {} mm: no part of it is below the gauge point",
                Short(*ends)
            );
            let help = "z counts from the gauge point down, towards the tip";
            self.fault("machine-body", last.z.span(), message, help);
        }
        profile
    }

    /// A profile whose points are in the order of z, their radii no less than zero.
    fn turned(&mut self, what: &str, points: &[ProfilePoint]) -> TurnedProfile {
        let mut profile = TurnedProfile::default();
        for ProfilePoint { z, r, way } in points {
            let [along, radius] = [z, r].map(|number| self.number(number));
            if radius < 0.0 {
                let message = format!("{what} has the radius {radius} mm, below zero");
                self.fault("machine-body", r.span(), message, "points are [z, r]");
            }
            let before = profile.points.last().copied();
            let back = before.filter(|[before, _]| along < *before);
            if let Some([before, _]) = back {
                let message =
                    format!("{what} goes back, from z = {} to {} mm", Short(before), Short(along));
                self.fault("machine-body", z.span(), message, "points [z, r] in the order of z");
            }
            // Told already, or an arc that begins nowhere.
            let sound = radius >= 0.0 && back.is_none();
            match way {
                Some(ProfileWayFile { arc }) if sound => {
                    self.arc(what, &mut profile, [along, radius], arc);
                }
                _ => profile.line_to([along, radius]),
            }
        }
        if let [point] = points {
            let help = "two points [z, r] make a cylinder or a cone";
            self.fault("machine-body", point.z.span(), format!("{what} has one point"), help);
        }
        profile
    }

    /// Takes a profile on along an arc; along a line if there is none, which is told.
    fn arc(&mut self, what: &str, profile: &mut TurnedProfile, to: [f64; 2], arc: &KeyedNumber) {
        let radius = self.number(arc);
        let begins = profile.is_empty();
        let told = profile.arc_to(to, radius).err();
        let (message, help) = match told {
            None if begins => (
                format!("{what} begins with an arc, and no point is before it"),
                "the first point is [z, r]",
            ),
            None => return,
            Some(NoArc::Short(apart)) => (
                format!(
                    "an arc of {} mm of {what} does not reach from one point to the next, {} mm away",
                    Short(radius),
                    Short(apart)
                ),
                "a radius of half the distance or more; the corner of an end mill of radius 5 is [0, 3], [2, 5, { arc = 2 }]",
            ),
            Some(NoArc::Back) => (
                format!("an arc of {} mm of {what} goes back in z on its way", Short(radius)),
                "arc bulges outwards, below zero it is hollow; or a larger radius, or a point between",
            ),
            Some(NoArc::Beyond(nearest)) => (
                format!(
                    "an arc of {} mm of {what} comes to r = {} mm, beyond the axis",
                    Short(radius),
                    Short(nearest)
                ),
                "a larger radius, or a point between",
            ),
        };
        self.fault("machine-body", arc.span(), message, help);
        if told.is_some() {
            profile.line_to(to);
        }
    }
}
