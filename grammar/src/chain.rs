//! The structural code of a machine: which axis stands where between workpiece and tool.

use crate::fault::SyntaxFault;
use pest::Parser;
use pest::error::InputLocation;
use pest_derive::Parser;
use std::ops::Range;

#[derive(Parser)]
#[grammar = "chain.pest"]
struct ChainGrammar;

/// One member of a structural code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// What it is.
    pub kind: LinkKind,
    /// Bytes of the code at which the member stands.
    pub span: Range<usize>,
}

/// What a member of a structural code is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkKind {
    /// `w`
    Workpiece,
    /// `b`
    Bed,
    /// `t`
    Tool,
    /// `X`, `C'`, `W2`
    Axis {
        /// A capital and digits.
        name: String,
        /// A prime follows it: the axis carries the workpiece.
        primed: bool,
    },
    /// `(S)`: a spindle that turns without being positioned.
    Spindle {
        /// A capital and digits.
        name: String,
    },
}

/// Longest structural code, in bytes: a machine has a handful of axes.
const LONGEST: usize = 1024;

const FORM: &str = "write it from workpiece to tool, such as [w C' A' b Y X Z (S) t]";

/// Reads a structural code of ISO 10791, such as `[w C' A' b Y X Z (S) t]`.
///
/// The code begins with `w`, ends with `t`, and has one `b` between. Which axes there are, whether a name comes twice
/// and whether the primes agree with the side of `b` is for the machine to judge.
pub fn parse_chain(text: &str) -> Result<Vec<Link>, SyntaxFault> {
    if text.len() > LONGEST {
        let message = format!("a structural code has at most {LONGEST} bytes");
        return Err(SyntaxFault::new(text, 0..text.len(), message).help(FORM));
    }
    let pairs = ChainGrammar::parse(Rule::chain, text).map_err(|error| {
        let at = match error.location {
            InputLocation::Pos(at) => at,
            InputLocation::Span((at, _)) => at,
        };
        unreadable(text, at)
    })?;
    let mut links = Vec::new();
    for pair in pairs.flat_map(|chain| chain.into_inner()) {
        let span = pair.as_span().start()..pair.as_span().end();
        let rule = pair.as_rule();
        let mut parts = pair.into_inner();
        let name = parts.next().map(|name| name.as_str().to_owned()).unwrap_or_default();
        let kind = match rule {
            Rule::workpiece => LinkKind::Workpiece,
            Rule::bed => LinkKind::Bed,
            Rule::tool => LinkKind::Tool,
            Rule::spindle => LinkKind::Spindle { name },
            Rule::axis => LinkKind::Axis { name, primed: parts.next().is_some() },
            _ => continue,
        };
        links.push(Link { kind, span });
    }
    check_ends(text, &links)?;
    Ok(links)
}

/// `w` first, `t` last, `b` once, none of them twice.
fn check_ends(text: &str, links: &[Link]) -> Result<(), SyntaxFault> {
    let fault =
        |span: Range<usize>, message: &str| Err(SyntaxFault::new(text, span, message).help(FORM));
    let open = text.find('[').map_or(0, |at| at + 1);
    let close = text.rfind(']').unwrap_or(text.len());
    for (kind, what) in [
        (LinkKind::Workpiece, "`w`, the workpiece,"),
        (LinkKind::Bed, "`b`, the bed,"),
        (LinkKind::Tool, "`t`, the tool,"),
    ] {
        let mut found = links.iter().filter(|link| link.kind == kind);
        let at = match kind {
            LinkKind::Workpiece => open,
            _ => close,
        };
        if found.next().is_none() {
            return fault(at..at, &format!("{what} is missing"));
        }
        if let Some(second) = found.next() {
            return fault(second.span.clone(), &format!("{what} stands here a second time"));
        }
    }
    match links {
        [first, ..] if first.kind != LinkKind::Workpiece => {
            fault(first.span.clone(), "a structural code begins with `w`, the workpiece")
        }
        [.., last] if last.kind != LinkKind::Tool => {
            fault(last.span.clone(), "a structural code ends with `t`, the tool")
        }
        _ => Ok(()),
    }
}

/// The fault of a code that pest could not go on with at `at`.
fn unreadable(text: &str, at: usize) -> SyntaxFault {
    let next = text[at..].chars().next();
    let span = at..at + next.map_or(0, char::len_utf8);
    let opened = text[..at].contains('[');
    let closed = text[..at].contains(']');
    let in_spindle = text[..at].rfind('(') > text[..at].rfind(')');
    let message = match next {
        _ if !opened => "a structural code begins with `[`".to_owned(),
        _ if closed => "nothing may follow the `]`".to_owned(),
        Some('(') => "a spindle is one axis name in parentheses".to_owned(),
        _ if in_spindle => "a spindle is one axis name in parentheses".to_owned(),
        None => "the closing `]` is missing".to_owned(),
        Some(letter) if letter.is_ascii_lowercase() => {
            format!(
                "`{letter}` is not a member: axes are capitals, `w`, `b` and `t` are workpiece, bed and tool"
            )
        }
        Some('\'' | '’' | '′') => {
            "a prime belongs directly behind the name of an axis".to_owned()
        }
        Some(other) => format!("`{other}` is not a member"),
    };
    SyntaxFault::new(text, span, message).help(FORM)
}
