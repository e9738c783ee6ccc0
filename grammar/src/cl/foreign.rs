//! Files of other formats that look a little like CL files: NC programs, and Mastercam's NCI.

use super::line::number_of;

/// Lines at the beginning of a file that are looked at.
const LOOKED_AT: usize = 40;

/// Lines that must look like blocks of a program for the file to be taken for one.
const ENOUGH: usize = 3;

/// What the file is that begins so, if it is no cutter-location file.
pub fn kind(head: &[u8]) -> Option<&'static str> {
    let head = String::from_utf8_lossy(head);
    let lines: Vec<&str> = head
        .split(['\n', '\r'])
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .take(LOOKED_AT)
        .collect();
    if lines.iter().any(|line| is_record(line)) {
        return None;
    }
    if is_nci(&lines) {
        return Some("Mastercam's NCI");
    }
    let begins = lines.first().is_some_and(|first| {
        let first = first.to_ascii_uppercase();
        *first == *"%" || first.starts_with("%_N_") || first.contains("BEGIN PGM")
    });
    let blocks = lines.iter().filter(|line| is_block(line)).count();
    (blocks >= ENOUGH || begins && blocks > 0).then_some("an NC program")
}

/// A word, then a slash: no line of a program.
fn is_record(line: &str) -> bool {
    let end = line.find(|letter: char| !letter.is_ascii_alphabetic()).unwrap_or(line.len());
    end > 1 && line[end..].trim_start().starts_with('/') || line.starts_with("$$")
}

/// A code by itself, then a line of numbers, from the first line on.
fn is_nci(lines: &[&str]) -> bool {
    let is_code = |line: &str| {
        line.len() <= 5 && !line.is_empty() && line.bytes().all(|byte| byte.is_ascii_digit())
    };
    let pairs = lines.chunks_exact(2).take(4);
    lines.len() >= 4
        && pairs.into_iter().all(|pair| {
            is_code(pair[0])
                && (pair[1].split_whitespace().all(|number| number_of(number).is_some())
                    || pair[1].starts_with('('))
        })
}

/// A block: words of a letter and a number (`N10 G0 X1.5`), at least one of them N, G, M or T; or one of Heidenhain
/// (`1 L X+10 FMAX`).
fn is_block(line: &str) -> bool {
    let mut code = String::new();
    let mut inside = false;
    for letter in line.chars() {
        match letter {
            '(' => inside = true,
            ')' => inside = false,
            ';' if !inside => break,
            letter if !inside => code.push(letter.to_ascii_uppercase()),
            _ => {}
        }
    }
    let mut heidenhain = code.split_whitespace();
    if heidenhain.next().is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()))
        && heidenhain
            .next()
            .is_some_and(|word| matches!(word, "L" | "TOOL" | "CYCL" | "BEGIN" | "BLK"))
    {
        return true;
    }
    let mut rest = code.trim_start_matches('/').trim_start();
    let mut telling = false;
    while let Some(letter) = rest.chars().next() {
        let Some(number) = rest.strip_prefix(|letter: char| letter.is_ascii_alphabetic()) else {
            return false;
        };
        let number = number.trim_start_matches('=');
        let end = number
            .find(|letter: char| !(letter.is_ascii_digit() || "+-.".contains(letter)))
            .unwrap_or(number.len());
        if end == 0 {
            return false;
        }
        telling |= matches!(letter, 'N' | 'G' | 'M' | 'T');
        rest = number[end..].trim_start();
    }
    telling
}
