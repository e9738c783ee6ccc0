//! A block of Heidenhain's conversational form, by its grammar.

use pest::Parser;
use pest::error::InputLocation;
use pest::iterators::{Pair, Pairs};
use pest_derive::Parser;

use super::block::{JumpDirection, NcBlock, NcFlow, NcItem, NcNumber, NcValue, NcWord};
use super::expression::{BinaryOperator, NcExpression, UnaryOperator};
use super::fault::Unreadable;
use super::number;
use super::pairs::{due, only};
use super::tree::{ExpressionTree, Precedence};

#[derive(Parser)]
#[grammar = "nc/conversational.pest"]
struct ConversationalGrammar;

type Parsed<T> = Result<T, Unreadable>;

/// Reads the block `code`, in capitals and without remarks; `original` is the same as it was written.
pub(super) fn parse(code: &str, original: &str, block: &mut NcBlock) -> Parsed<()> {
    let pairs = ConversationalGrammar::parse(Rule::block, code).map_err(|error| {
        let at = match error.location {
            InputLocation::Pos(at) => at,
            InputLocation::Span((at, _)) => at,
        };
        unreadable(code, at)
    })?;
    let builder = ConversationalBuilder { original };
    for pair in pairs.flat_map(Pair::into_inner) {
        let span = pair.as_span().start()..pair.as_span().end();
        builder.part(pair, block).map_err(|fault| fault.at(span))?;
    }
    Ok(())
}

/// The block defines a cycle, whose parameters may stand in lines of their own.
pub(super) fn defines_cycle(code: &str) -> bool {
    let code = code.trim_start();
    let body = code.trim_start_matches(|each: char| each.is_ascii_digit());
    body.len() < code.len() && body.trim_start().starts_with("CYCL DEF")
}

/// A line that gives a parameter and has no number: `Q200=+2`.
pub(super) fn gives_parameter(line: &[u8]) -> bool {
    let [b'Q' | b'q', digits @ ..] = line.trim_ascii_start() else {
        return false;
    };
    let count = digits.iter().take_while(|byte| byte.is_ascii_digit()).count();
    count > 0 && digits[count..].trim_ascii_start().starts_with(b"=")
}

/// The fault of a block that pest could not go on with at `at`.
fn unreadable(code: &str, at: usize) -> Unreadable {
    let next = code[at..].chars().next();
    let message = match next {
        None => "the block ends where a value is due".to_owned(),
        Some('"') => "this `\"` is not closed".to_owned(),
        Some('=') => "what stands in front of `=` is no variable".to_owned(),
        Some(other) => format!("`{other}` does not belong here"),
    };
    Unreadable::new(message).at(at..at + next.map_or(0, char::len_utf8))
}

/// Pairs of the grammar to what a block says.
struct ConversationalBuilder<'t> {
    original: &'t str,
}

impl ConversationalBuilder<'_> {
    fn part(&self, pair: Pair<'_, Rule>, block: &mut NcBlock) -> Parsed<()> {
        let rule = pair.as_rule();
        let spelling = pair.as_str();
        let item = match rule {
            Rule::EOI => return Ok(()),
            Rule::skip => {
                block.skipped = true;
                return Ok(());
            }
            Rule::number_of_block => {
                block.number = Some(number::whole(spelling)?);
                return Ok(());
            }
            Rule::structure => {
                let heading = self.written(&pair).trim_start_matches(['*', '-', ' ', '\t']);
                block.remarks.push(heading.trim_end().to_owned());
                return Ok(());
            }
            Rule::program_end => return self.program_end(pair, block),
            Rule::cycle_title => return self.cycle(pair, block),
            Rule::label => NcItem::Flow(Box::new(match self.label(only(pair))? {
                name if name == "0" => NcFlow::LabelEnd,
                name => NcFlow::Label(name),
            })),
            Rule::call_label => {
                let mut parts = pair.into_inner();
                let target = self.label(due(&mut parts)?)?;
                let repeat = parts.next().map(|value| self.expression_of(value)).transpose()?;
                let arguments = Vec::new();
                NcItem::Flow(Box::new(NcFlow::Call { target, repeat, arguments }))
            }
            Rule::call_program => {
                let name = self.written(&only(pair)).to_owned();
                NcItem::Flow(Box::new(NcFlow::CallProgram(name)))
            }
            Rule::function_number => self.function_number(pair)?,
            Rule::formula => {
                let mut parts = pair.into_inner();
                assign(due(&mut parts)?.as_str(), self.expression(due(&mut parts)?)?)
            }
            Rule::parameter | Rule::named => self.named(pair)?,
            Rule::keyword | Rule::sided | Rule::radius | Rule::name => {
                NcItem::Name(one_blank(spelling).into())
            }
            Rule::fast => {
                NcItem::Name(spelling.split_ascii_whitespace().collect::<String>().into())
            }
            Rule::text => NcItem::Text(self.text(pair)),
            Rule::number => NcItem::Number(number::number(spelling)?),
            Rule::word | Rule::incremental => self.word(pair)?,
            _ => return Err(Unreadable::new("this cannot be read")),
        };
        block.items.push(item);
        Ok(())
    }

    /// `BEGIN PGM NAME MM`
    fn program_end(&self, pair: Pair<'_, Rule>, block: &mut NcBlock) -> Parsed<()> {
        let keyword = if pair.as_str().starts_with("BEGIN") { "BEGIN PGM" } else { "END PGM" };
        block.items.push(NcItem::Name(keyword.into()));
        for part in pair.into_inner() {
            block.items.push(match part.as_rule() {
                Rule::unit => NcItem::Name(part.as_str().to_owned().into()),
                _ => NcItem::Text(self.written(&part).to_owned()),
            });
        }
        Ok(())
    }

    /// `CYCL DEF 200 DRILLING Q200=+2`
    fn cycle(&self, pair: Pair<'_, Rule>, block: &mut NcBlock) -> Parsed<()> {
        block.items.push(NcItem::Name("CYCL DEF".into()));
        for part in pair.into_inner() {
            block.items.push(match part.as_rule() {
                Rule::cycle_number => NcItem::Number(number::number(part.as_str())?),
                Rule::title if part.as_str().trim().is_empty() => continue,
                Rule::title => NcItem::Text(self.written(&part).trim().to_owned()),
                _ => self.named(part)?,
            });
        }
        Ok(())
    }

    fn word(&self, pair: Pair<'_, Rule>) -> Parsed<NcItem> {
        let incremental = pair.as_rule() == Rule::incremental;
        let mut parts = pair.into_inner();
        Ok(NcItem::Word(NcWord {
            letter: due(&mut parts)?.as_str().as_bytes()[0],
            incremental,
            value: self.value(due(&mut parts)?)?,
        }))
    }

    fn named(&self, pair: Pair<'_, Rule>) -> Parsed<NcItem> {
        let mut parts = pair.into_inner();
        let name = due(&mut parts)?.as_str().to_owned().into();
        let value = due(&mut parts)?;
        let value = match value.as_rule() {
            Rule::text => NcValue::Text(self.text(value)),
            Rule::whole => NcValue::Number(number::number(value.as_str())?),
            _ => self.value(value)?,
        };
        Ok(NcItem::Named { name, value })
    }

    /// `+5`, `-Q1`
    fn value(&self, pair: Pair<'_, Rule>) -> Parsed<NcValue> {
        let negative = pair.as_str().starts_with('-');
        let mut last = due(&mut pair.into_inner().rev())?;
        if last.as_rule() == Rule::sign {
            last = only(last);
        }
        if last.as_rule() == Rule::number {
            let found: NcNumber = number::number(last.as_str())?;
            return Ok(NcValue::Number(found.signed(negative)));
        }
        let variable = NcExpression::Variable(last.as_str().to_owned());
        let expression = if negative {
            NcExpression::Unary(UnaryOperator::Minus, Box::new(variable))
        } else {
            variable
        };
        Ok(NcValue::Expression(Box::new(expression)))
    }

    /// Reads the same words as an expression.
    fn expression_of(&self, pair: Pair<'_, Rule>) -> Parsed<NcExpression> {
        Ok(match self.value(pair)? {
            NcValue::Number(number) => NcExpression::Number(number.value),
            NcValue::Expression(expression) => *expression,
            NcValue::Text(text) => NcExpression::Text(text),
            NcValue::Approached(..) => return Err(Unreadable::new("this is no value")),
        })
    }

    /// A function by its number: a value, or a jump.
    fn function_number(&self, pair: Pair<'_, Rule>) -> Parsed<NcItem> {
        let mut told = None;
        let mut body = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::whole => told = Some(number::whole(part.as_str())?),
                _ => body = Some(part),
            }
        }
        let body =
            body.ok_or_else(|| Unreadable::new("a function is missing behind its number"))?;
        let rule = body.as_rule();
        let mut parts = body.into_inner();
        if rule == Rule::jump {
            return self.jump(told, parts);
        }
        let variable = due(&mut parts)?.as_str();
        let (own, value) = match rule {
            Rule::set => (0, self.expression_of(due(&mut parts)?)?),
            Rule::one => {
                let name = due(&mut parts)?.as_str().to_owned();
                let own = match name.as_str() {
                    "SQRT" => 5,
                    "SIN" => 6,
                    _ => 7,
                };
                let arguments = vec![self.expression_of(due(&mut parts)?)?];
                (own, NcExpression::Function { name, arguments })
            }
            _ => {
                let left = self.expression_of(due(&mut parts)?)?;
                let sign = due(&mut parts)?.as_str();
                let right = self.expression_of(due(&mut parts)?)?;
                two_sided(sign, left, right)
            }
        };
        check_number(told, own)?;
        Ok(assign(variable, value))
    }

    /// `IF +Q1 EQU +5 GOTO LBL 3`
    fn jump(&self, told: Option<u64>, mut parts: Pairs<'_, Rule>) -> Parsed<NcItem> {
        let left = Box::new(self.expression_of(due(&mut parts)?)?);
        let (own, operator) = match due(&mut parts)?.as_str() {
            "EQU" => (9, BinaryOperator::Equal),
            "NE" => (10, BinaryOperator::NotEqual),
            "GT" => (11, BinaryOperator::Greater),
            _ => (12, BinaryOperator::Less),
        };
        check_number(told, own)?;
        let right = Box::new(self.expression_of(due(&mut parts)?)?);
        Ok(NcItem::Flow(Box::new(NcFlow::Goto {
            target: NcExpression::Text(self.label(due(&mut parts)?)?),
            direction: JumpDirection::Anywhere,
            condition: Some(NcExpression::Binary(operator, left, right)),
        })))
    }

    /// Operands and operators in a row.
    fn expression(&self, pair: Pair<'_, Rule>) -> Parsed<NcExpression> {
        let mut tree = ExpressionTree::new(Precedence::Conversational);
        let mut prefixes = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::prefix => prefixes.push(part.as_str()),
                Rule::infix => tree.operator(part.as_str())?,
                rule => {
                    let mut operand = match rule {
                        Rule::number => NcExpression::Number(number::value(part.as_str())?),
                        Rule::text => NcExpression::Text(self.text(part)),
                        Rule::expression => self.expression(part)?,
                        _ => NcExpression::Variable(part.as_str().to_owned()),
                    };
                    let signed = !prefixes.is_empty();
                    while let Some(prefix) = prefixes.pop() {
                        operand = prefixed(prefix, operand);
                    }
                    tree.operand(operand, signed);
                }
            }
        }
        tree.finish()
    }

    /// `5`, `"NAME"`
    fn label(&self, pair: Pair<'_, Rule>) -> Parsed<String> {
        match pair.as_rule() {
            Rule::text => Ok(self.text(pair).to_ascii_uppercase()),
            _ => Ok(number::whole(pair.as_str())?.to_string()),
        }
    }

    /// The text in quotation marks, as written.
    fn text(&self, pair: Pair<'_, Rule>) -> String {
        self.written(&only(pair)).to_owned()
    }

    fn written(&self, pair: &Pair<'_, Rule>) -> &str {
        let span = pair.as_span();
        &self.original[span.start()..span.end()]
    }
}

fn assign(variable: &str, value: NcExpression) -> NcItem {
    NcItem::Assign {
        variable: Box::new(NcExpression::Variable(variable.to_owned())),
        value: Box::new(value),
    }
}

/// The number of a function, and what it gives.
fn two_sided(sign: &str, left: NcExpression, right: NcExpression) -> (u64, NcExpression) {
    use BinaryOperator as B;
    let (own, operator) = match sign {
        "+" => (1, B::Add),
        "-" => (2, B::Subtract),
        "*" => (3, B::Multiply),
        "DIV" => (4, B::Divide),
        other => {
            let function =
                NcExpression::Function { name: other.to_owned(), arguments: vec![left, right] };
            return (if other == "LEN" { 8 } else { 13 }, function);
        }
    };
    (own, NcExpression::Binary(operator, Box::new(left), Box::new(right)))
}

/// A function that does not belong to its number is not guessed at.
fn check_number(told: Option<u64>, own: u64) -> Parsed<()> {
    match told {
        Some(told) if told != own => {
            Err(Unreadable::new(format!("FN {told} is not this function: that is FN {own}")))
        }
        _ => Ok(()),
    }
}

fn prefixed(prefix: &str, operand: NcExpression) -> NcExpression {
    match prefix {
        "+" => operand,
        "-" => NcExpression::Unary(UnaryOperator::Minus, Box::new(operand)),
        name => NcExpression::Function { name: name.to_owned(), arguments: vec![operand] },
    }
}

/// Words with one blank between them.
fn one_blank(text: &str) -> String {
    let mut words = text.split_ascii_whitespace();
    let mut name = words.next().unwrap_or_default().to_owned();
    for word in words {
        name.push(' ');
        name.push_str(word);
    }
    name
}
