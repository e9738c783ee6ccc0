//! Triangles of an STL file, one after the other.
//!
//! A binary file is known by its length, as the header of many begins with `solid` like a text: 80 bytes, the number of
//! triangles (32 bits, least byte first), and for each 50 bytes (the normal, three corners, two more bytes; numbers of
//! 32 bits). Of a text the lines `vertex x y z` count, three to a facet. Normals are not looked at: they follow from
//! the corners.

use std::fmt;
use std::io::{self, BufRead, Read as _, Seek, SeekFrom};

use super::Vertex;

/// Largest coordinate, mm: a kilometre is no machine.
const FARTHEST: f64 = 1e6;

/// Longest line of a text.
const LONGEST: u64 = 4096;

/// Most bytes of a file.
const MOST_BYTES: u64 = 1 << 30;

/// Why a file is no shape.
#[derive(Debug)]
pub enum StlFault {
    /// The file cannot be read.
    Io(io::Error),
    /// The file is too long.
    TooLong(u64),
    /// The file holds no triangle that has an area.
    Empty,
    /// A text ends before its end.
    Cut,
    /// Neither the length of a binary file, nor the beginning of a text.
    Neither(u64),
    /// A line of a text, from 1, and what is wrong with it.
    Line(u64, &'static str),
    /// A corner that is no number or far away, in the triangle from 1.
    Far(u64),
}

impl fmt::Display for StlFault {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(out, "{error}"),
            Self::Cut => write!(out, "it was cut off: it ends before `endsolid`"),
            Self::TooLong(bytes) => {
                write!(out, "it has {bytes} bytes; at most {MOST_BYTES} are read")
            }
            Self::Empty => write!(
                out,
                "it holds no triangle with an area that is seen; coordinates are taken as mm"
            ),
            Self::Neither(bytes) => write!(
                out,
                "it is no STL file: it has {bytes} bytes, which is not what its header says of a binary one, and does not begin with `solid` as a text does"
            ),
            Self::Line(line, what) => write!(out, "line {line}: {what}"),
            Self::Far(triangle) => write!(
                out,
                "a corner of triangle {triangle} is no number or farther than {FARTHEST:.0} mm from the origin"
            ),
        }
    }
}

impl From<io::Error> for StlFault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Hands every triangle of a file to `take`, from the file's beginning.
pub(super) fn read(
    file: &mut (impl BufRead + Seek),
    take: &mut dyn FnMut([Vertex; 3]),
) -> Result<(), StlFault> {
    let length = file.seek(SeekFrom::End(0))?;
    file.rewind()?;
    if length > MOST_BYTES {
        return Err(StlFault::TooLong(length));
    }
    let mut count = 0;
    let mut take = |triangle: [Vertex; 3]| {
        count += 1;
        let near = |value: &f64| value.abs() <= FARTHEST;
        if !triangle.iter().flatten().all(near) {
            return Err(StlFault::Far(count));
        }
        take(triangle);
        Ok(())
    };
    let mut header = Vec::new();
    file.by_ref().take(84).read_to_end(&mut header)?;
    match header.last_chunk::<4>() {
        Some(triangles)
            if header.len() == 84
                && length == 84 + 50 * u64::from(u32::from_le_bytes(*triangles)) =>
        {
            binary(file, u32::from_le_bytes(*triangles), &mut take)?;
        }
        // One that was cut off has the number of its triangles there, which is no text.
        _ if header.trim_ascii_start().to_ascii_lowercase().starts_with(b"solid")
            && !header.contains(&0) =>
        {
            file.rewind()?;
            text(file, &mut take)?;
        }
        _ => return Err(StlFault::Neither(length)),
    }
    match count {
        0 => Err(StlFault::Empty),
        _ => Ok(()),
    }
}

fn binary(
    file: &mut impl BufRead,
    count: u32,
    take: &mut dyn FnMut([Vertex; 3]) -> Result<(), StlFault>,
) -> Result<(), StlFault> {
    let mut record = [0; 50];
    for _ in 0..count {
        file.read_exact(&mut record)?;
        let (numbers, _) = record.as_chunks::<4>();
        let number = |at: usize| f64::from(f32::from_le_bytes(numbers[at]));
        let corner = |at: usize| [number(at), number(at + 1), number(at + 2)];
        take([corner(3), corner(6), corner(9)])?;
    }
    Ok(())
}

/// Words that a line of a text begins with.
const WORDS: [&str; 7] = ["vertex", "facet", "outer", "endloop", "endfacet", "solid", "endsolid"];

/// The next word of a line, what is no letter of a text among the spaces.
fn word_of<'a>(line: &mut &'a [u8]) -> Option<&'a [u8]> {
    let is_space = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, 0 | 0x1a);
    let begin = line.iter().position(|byte| !is_space(byte))?;
    let rest = &line[begin..];
    let (word, rest) = rest.split_at(rest.iter().position(is_space).unwrap_or(rest.len()));
    *line = rest;
    Some(word)
}

fn text(
    file: &mut impl BufRead,
    take: &mut dyn FnMut([Vertex; 3]) -> Result<(), StlFault>,
) -> Result<(), StlFault> {
    let mut line = Vec::new();
    let mut corners = Vec::with_capacity(3);
    let mut ended = false;
    for number in 1.. {
        line.clear();
        if file.by_ref().take(LONGEST).read_until(b'\n', &mut line)? == 0 {
            break;
        }
        if !line.ends_with(b"\n") {
            file.skip_until(b'\n')?;
        }
        let fault = |what| Err(StlFault::Line(number, what));
        // The first line may be `solid` and a name in one.
        if number == 1 {
            continue;
        }
        // Names may be of any letters; some systems end a text with a letter of their own.
        let mut rest = line.as_slice();
        let Some(word) = word_of(&mut rest) else { continue };
        let known = WORDS.iter().find(|known| word.eq_ignore_ascii_case(known.as_bytes()));
        let known = known.copied().unwrap_or_default();
        ended = known == "endsolid";
        match known {
            "vertex" if corners.len() < 3 => {
                let mut corner = [0.0; 3];
                for value in &mut corner {
                    let found = word_of(&mut rest).and_then(|word| str::from_utf8(word).ok());
                    let Some(found) = found.and_then(|word| word.parse().ok()) else {
                        return fault("`vertex` and three numbers are expected");
                    };
                    *value = found;
                }
                corners.push(corner);
            }
            "vertex" => return fault("a facet has three corners, and this is a fourth"),
            "endloop" => {
                let Ok(triangle) = <[Vertex; 3]>::try_from(corners.as_slice()) else {
                    return fault("a facet has three corners, and here it ends with fewer");
                };
                take(triangle)?;
                corners.clear();
            }
            "solid" | "facet" | "outer" | "endfacet" | "endsolid" => {}
            _ => return fault("no line of an STL file begins so"),
        }
    }
    match ended {
        true => Ok(()),
        false => Err(StlFault::Cut),
    }
}
