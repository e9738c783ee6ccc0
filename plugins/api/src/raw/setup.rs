//! Setup and format as they cross the border, and back.

#![allow(unsafe_code)]

use std::ptr::null;

use super::{
    MAX_WORDS, PostAxisWord, PostFormat, PostPair, PostSetup, PostText, PostTool, pairs, slice,
};
use crate::{
    Accuracy, Ahead, AxisWord, Capabilities, Format, Language, PlaneAngles, Setup, Tolerance, Tool,
    Units,
};

/// Hands `setup` to `take` in its raw form.
pub fn with_setup<R>(setup: &Setup<'_>, take: impl FnOnce(&PostSetup) -> R) -> R {
    let words: Vec<PostAxisWord> = setup
        .words
        .iter()
        .map(|word| {
            let [least, largest] = word.travel.unwrap_or([f64::NAN; 2]);
            PostAxisWord {
                name: PostText::new(word.name),
                rotary: match (word.rotary, word.wrapped, word.signed) {
                    (false, ..) => 0,
                    (true, false, false) => 1,
                    (true, true, _) => 2,
                    (true, false, true) => 3,
                },
                depth: word.depth.into(),
                carries_part: word.carries_part.into(),
                reserved: 0,
                least,
                largest,
            }
        })
        .collect();
    let options: Vec<PostPair> =
        setup.options.iter().map(|(key, value)| PostPair::new(key, value)).collect();
    let or_nan = |number: Option<f64>| number.unwrap_or(f64::NAN);
    let ahead = setup.ahead.as_ref();
    let tools: Vec<PostTool> = ahead
        .map_or(&[][..], |ahead| ahead.tools)
        .iter()
        .map(|tool| PostTool {
            name: PostText::new(tool.name),
            number: tool.number,
            reserved: 0,
            length: or_nan(tool.length),
            diameter: or_nan(tool.diameter),
            corner_radius: or_nan(tool.corner_radius),
        })
        .collect();
    let extents = ahead.and_then(|ahead| ahead.extents);
    let [least, largest] = extents.unwrap_or_default();
    take(&PostSetup {
        size: size_of::<PostSetup>() as u64,
        program: PostText::new(setup.program),
        machine: PostText::new(setup.machine),
        units: setup.units.code(),
        tcp: setup.tcp.into(),
        words: words.as_ptr(),
        words_len: words.len(),
        options: options.as_ptr(),
        options_len: options.len(),
        cl_file: PostText::new(setup.cl_file),
        tip_tolerance: setup.accuracy.map_or(0.0, |accuracy| accuracy.cut.tip),
        axis_tolerance: setup.accuracy.map_or(0.0, |accuracy| accuracy.cut.axis),
        rapid_tolerance: setup.accuracy.map_or(0.0, |accuracy| accuracy.rapid),
        ahead: ahead.is_some().into(),
        moves: extents.is_some().into(),
        tools: tools.as_ptr(),
        tools_len: tools.len(),
        least,
        largest,
        time: or_nan(ahead.and_then(|ahead| ahead.time)),
        turns_part: setup.turns_part.into(),
        diameters: diameters(setup.words),
    })
}

/// The bits of the words that are diameters.
fn diameters(words: &[AxisWord<'_>]) -> u32 {
    let places = words.iter().take(32).enumerate().filter(|(_, word)| word.diameter);
    places.fold(0, |bits, (place, _)| bits | 1 << place)
}

impl PostSetup {
    /// Nothing known.
    const EMPTY: PostSetup = PostSetup {
        size: 0,
        program: PostText::EMPTY,
        machine: PostText::EMPTY,
        units: 0,
        tcp: 0,
        words: null(),
        words_len: 0,
        options: null(),
        options_len: 0,
        cl_file: PostText::EMPTY,
        tip_tolerance: 0.0,
        axis_tolerance: 0.0,
        rapid_tolerance: 0.0,
        ahead: 0,
        moves: 0,
        tools: null(),
        tools_len: 0,
        least: [0.0; 3],
        largest: [0.0; 3],
        time: f64::NAN,
        turns_part: 0,
        diameters: 0,
    };

    /// Hands the setup at `this` to `take` in its safe form; none if a text is not valid or the units are not
    /// known. What a host of an earlier version does not tell is as if it did not know it.
    ///
    /// # Safety
    /// `this` leads to as many bytes as its `size` says, and every pointer in them is valid for the call.
    pub unsafe fn with<R>(this: *const Self, take: impl FnOnce(&Setup<'_>) -> R) -> Option<R> {
        let mut raw = PostSetup::EMPTY;
        // SAFETY: handed on to the caller, here and in the calls below.
        unsafe {
            let size = usize::try_from((*this).size).ok()?;
            std::ptr::copy_nonoverlapping(
                this.cast::<u8>(),
                (&raw mut raw).cast::<u8>(),
                size.min(size_of::<Self>()),
            );
        }
        let raw_words = unsafe { slice(raw.words, raw.words_len) };
        let mut words = Vec::with_capacity(raw_words.len());
        for (place, word) in raw_words.iter().enumerate() {
            words.push(AxisWord {
                name: unsafe { word.name.get() }?,
                rotary: word.rotary != 0,
                wrapped: word.rotary == 2,
                signed: word.rotary == 3,
                depth: word.depth != 0,
                carries_part: word.carries_part != 0,
                diameter: place < 32 && raw.diameters >> place & 1 == 1,
                travel: (!word.least.is_nan()).then_some([word.least, word.largest]),
            });
        }
        let raw_tools = unsafe { slice(raw.tools, raw.tools_len) };
        let known = |number: f64| (!number.is_nan()).then_some(number);
        let mut tools = Vec::with_capacity(raw_tools.len());
        for tool in raw_tools {
            tools.push(Tool {
                number: tool.number,
                name: unsafe { tool.name.get() }?,
                length: known(tool.length),
                diameter: known(tool.diameter),
                corner_radius: known(tool.corner_radius),
            });
        }
        let options = unsafe { pairs(raw.options, raw.options_len) }?;
        Some(take(&Setup {
            program: unsafe { raw.program.get() }?,
            machine: unsafe { raw.machine.get() }?,
            units: Units::of(raw.units)?,
            tcp: raw.tcp != 0,
            turns_part: raw.turns_part != 0,
            words: &words,
            options: &options,
            cl_file: unsafe { raw.cl_file.get() }?,
            accuracy: (raw.tip_tolerance > 0.0).then_some(Accuracy {
                cut: Tolerance { tip: raw.tip_tolerance, axis: raw.axis_tolerance },
                rapid: raw.rapid_tolerance,
            }),
            ahead: (raw.ahead != 0).then_some(Ahead {
                tools: &tools,
                extents: (raw.moves != 0).then_some([raw.least, raw.largest]),
                time: known(raw.time),
            }),
        }))
    }
}

impl PostFormat {
    /// All zero but for its size, as the host hands it over.
    pub const EMPTY: PostFormat = PostFormat {
        size: size_of::<PostFormat>() as u64,
        words: [0; MAX_WORDS],
        feed: 0,
        inverse_time: 0,
        feed_per_revolution: 0,
        words_len: 0,
        extension: [0; 16],
        writes: 0,
        most_inverse_time: 0.0,
        plane_angles: 0,
        plane_decimals: 0,
        language: 0,
        reserved: 0,
        rapid_feed: 0.0,
    };

    /// `format` as it crosses the border; none if it has too many words or too long an extension.
    pub fn new(format: &Format, capabilities: Capabilities) -> Option<Self> {
        let mut raw = PostFormat {
            feed: format.feed.into(),
            inverse_time: format.inverse_time.map_or(-1, i32::from),
            feed_per_revolution: format.feed_per_revolution.into(),
            words_len: format.words.len() as u32,
            writes: capabilities.bits(),
            most_inverse_time: format.most_inverse_time.unwrap_or(0.0),
            rapid_feed: format.rapid_feed.unwrap_or(0.0),
            plane_angles: format.plane_angles.code(),
            plane_decimals: format.plane_decimals.into(),
            language: format.language.code(),
            ..PostFormat::EMPTY
        };
        raw.words.get_mut(..format.words.len())?.copy_from_slice(&format.words);
        raw.extension
            .get_mut(..format.extension.len())?
            .copy_from_slice(format.extension.as_bytes());
        Some(raw)
    }

    /// How the control is told a tilted plane; none if this version does not know it.
    pub fn plane(&self) -> Option<PlaneAngles> {
        PlaneAngles::of(self.plane_angles)
    }

    /// What its programs are written in; none if this version does not know it.
    pub fn language(&self) -> Option<Language> {
        Language::of(self.language)
    }

    /// Writes it to `to`, as much of it as a host of an earlier version has room for.
    ///
    /// # Safety
    /// `to` leads to as many bytes as its `size` says.
    pub unsafe fn write(mut self, to: *mut Self) {
        // SAFETY: handed on to the caller.
        unsafe {
            self.size = (*to).size;
            let size = usize::try_from(self.size).unwrap_or(0);
            std::ptr::copy_nonoverlapping(
                (&raw const self).cast::<u8>(),
                to.cast::<u8>(),
                size.min(size_of::<Self>()),
            );
        }
    }
}
