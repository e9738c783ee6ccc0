//! A block of a word program, by its grammar.

use pest::Parser;
use pest::error::InputLocation;
use pest::iterators::{Pair, Pairs};
use pest_derive::Parser;

use super::block::{
    Across, Approach, JumpDirection, NcBlock, NcFlow, NcItem, NcNumber, NcSyntax, NcValue, NcWord,
};
use super::expression::{NcExpression, UnaryOperator};
use super::fault::Unreadable;
use super::number;
use super::pairs::{due, only};
use super::tree::{ExpressionTree, Precedence};

#[derive(Parser)]
#[grammar = "nc/words.pest"]
struct WordsGrammar;

type Parsed<T> = Result<T, Unreadable>;

/// Reads the block `code`, in capitals and without remarks; `original` is the same as it was written.
pub(super) fn parse(
    code: &str,
    original: &str,
    syntax: &NcSyntax,
    block: &mut NcBlock,
) -> Parsed<()> {
    let rule = match (syntax.instructions, syntax.hash_variables) {
        (true, _) => Rule::instruction_block,
        (false, true) => Rule::hash_block,
        (false, false) => Rule::name_block,
    };
    // The brackets of expressions are those of the first family.
    let hash = syntax.instructions || syntax.hash_variables;
    let pairs = WordsGrammar::parse(rule, code).map_err(|error| {
        let at = match error.location {
            InputLocation::Pos(at) => at,
            InputLocation::Span((at, _)) => at,
        };
        unreadable(code, at, hash)
    })?;
    let builder = WordsBuilder { original, hash };
    for pair in pairs.flat_map(Pair::into_inner) {
        let span = pair.as_span().start()..pair.as_span().end();
        builder.item(pair, block).map_err(|fault| fault.at(span))?;
    }
    Ok(())
}

/// The fault of a block that pest could not go on with at `at`.
fn unreadable(code: &str, at: usize, hash: bool) -> Unreadable {
    let next = code[at..].chars().next();
    let before = code[..at].trim_end().chars().next_back();
    let (message, help) = match next {
        None => ("the block ends where a value is due".to_owned(), None),
        Some('%') => {
            ("`%` stands alone in a line".to_owned(), Some("it begins and ends a program"))
        }
        Some('(') if hash => ("this `(` is not closed".to_owned(), None),
        Some(')') => ("this `)` closes nothing".to_owned(), None),
        Some(']') => ("this `]` closes nothing".to_owned(), None),
        Some('"') => ("this `\"` is not closed".to_owned(), None),
        Some(digit) if digit.is_ascii_digit() => (
            "a number without a letter".to_owned(),
            Some("the letter of an address stands in front of its number"),
        ),
        Some(other) if before.is_some_and(|before| before.is_ascii_uppercase()) => {
            (format!("a number is due, not `{other}`"), None)
        }
        Some(other) => (format!("`{other}` does not belong here"), None),
    };
    let fault = Unreadable::new(message).at(at..at + next.map_or(0, char::len_utf8));
    match help {
        Some(help) => fault.help(help),
        None => fault,
    }
}

/// Pairs of the grammar to what a block says.
struct WordsBuilder<'t> {
    original: &'t str,
    hash: bool,
}

impl WordsBuilder<'_> {
    fn item(&self, pair: Pair<'_, Rule>, block: &mut NcBlock) -> Parsed<()> {
        let item = match pair.as_rule() {
            Rule::skip => {
                block.skipped = true;
                return Ok(());
            }
            Rule::number_of_block | Rule::main_block => {
                block.number = Some(number::whole(only(pair).as_str())?);
                return Ok(());
            }
            Rule::EOI => return Ok(()),
            Rule::define => return self.define(pair, block),
            Rule::hash_word | Rule::word => self.word(pair)?,
            Rule::hash_named | Rule::named => self.named(pair)?,
            Rule::name => NcItem::Name(pair.as_str().to_owned().into()),
            Rule::instruction => self.instruction(pair)?,
            Rule::call => self.call(pair)?,
            Rule::hash_assign | Rule::assign => {
                let mut parts = pair.into_inner();
                NcItem::Assign {
                    variable: Box::new(self.primary(due(&mut parts)?)?),
                    value: Box::new(self.expression(due(&mut parts)?)?),
                }
            }
            _ => NcItem::Flow(Box::new(self.flow(pair)?)),
        };
        block.items.push(item);
        Ok(())
    }

    fn word(&self, pair: Pair<'_, Rule>) -> Parsed<NcItem> {
        let mut parts = pair.into_inner();
        let mut first = due(&mut parts)?;
        let comma = first.as_rule() == Rule::comma;
        if comma {
            first = due(&mut parts)?;
        }
        let value = self.value(due(&mut parts)?)?;
        if comma {
            let name = format!(",{}", first.as_str()).into();
            return Ok(NcItem::Named { name, value });
        }
        let (incremental, value) = match value {
            NcValue::Approached(Approach::Incremental, value) => (true, *value),
            value => (false, value),
        };
        Ok(NcItem::Word(NcWord { letter: first.as_str().as_bytes()[0], incremental, value }))
    }

    fn named(&self, pair: Pair<'_, Rule>) -> Parsed<NcItem> {
        let mut parts = pair.into_inner();
        Ok(NcItem::Named {
            name: due(&mut parts)?.as_str().to_owned().into(),
            value: self.value(due(&mut parts)?)?,
        })
    }

    fn call(&self, pair: Pair<'_, Rule>) -> Parsed<NcItem> {
        let mut parts = pair.into_inner();
        let name = due(&mut parts)?.as_str().to_owned();
        let mut arguments = Vec::new();
        for argument in parts {
            let value = argument.into_inner().next();
            arguments.push(value.map(|value| self.value(value)).transpose()?);
        }
        // `NAME()` has one place, and nothing in it.
        if arguments.len() == 1 && arguments[0].is_none() {
            arguments.clear();
        }
        Ok(NcItem::Call { name, arguments })
    }

    /// `#RTCP ON` is a name, `#CS ON [1] [MODE 1, 0, 0, 10, 30, 0, 0]` a call: what stands in brackets ahead of the last
    /// is a text of its own among its arguments, and so are words.
    fn instruction(&self, pair: Pair<'_, Rule>) -> Parsed<NcItem> {
        let mut parts = pair.into_inner();
        let words: Vec<&str> = due(&mut parts)?.as_str().split_whitespace().collect();
        let name = format!("#{}", words.join(" "));
        let mut arguments = Vec::new();
        while let Some(values) = parts.next() {
            if parts.peek().is_some() {
                arguments.push(Some(NcValue::Text(values.as_str().to_owned())));
                continue;
            }
            for value in values.into_inner() {
                let Some(value) = value.into_inner().next() else {
                    arguments.push(None);
                    continue;
                };
                arguments.push(Some(match value.as_rule() {
                    Rule::text => NcValue::Text(self.text(value)),
                    Rule::instruction_words => NcValue::Text(value.as_str().trim().to_owned()),
                    _ => self.value(value)?,
                }));
            }
        }
        Ok(match arguments.is_empty() {
            true => NcItem::Name(name.into()),
            false => NcItem::Call { name, arguments },
        })
    }

    /// `DEF REAL _X, _Y=5`: the name `DEF REAL`, then each variable, by name or with its first value.
    fn define(&self, pair: Pair<'_, Rule>, block: &mut NcBlock) -> Parsed<()> {
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::r#type => {
                    block.items.push(NcItem::Name(format!("DEF {}", part.as_str()).into()))
                }
                Rule::definition => {
                    let mut parts = part.into_inner().peekable();
                    let name = due(&mut parts)?.as_str().to_owned();
                    block.items.push(match parts.next() {
                        None => NcItem::Name(name.into()),
                        Some(value) if value.as_rule() == Rule::first_value => NcItem::Assign {
                            variable: Box::new(NcExpression::Variable(name)),
                            value: Box::new(self.expression(only(value))?),
                        },
                        Some(_) if parts.peek().is_some() => {
                            return Err(Unreadable::new("a field with first values is not read"));
                        }
                        Some(size) => NcItem::Named {
                            name: name.into(),
                            value: NcValue::Expression(Box::new(self.expression(size)?)),
                        },
                    });
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn value(&self, pair: Pair<'_, Rule>) -> Parsed<NcValue> {
        match pair.as_rule() {
            Rule::value => self.value(only(pair)),
            Rule::approached => {
                let mut parts = pair.into_inner();
                let approach = match due(&mut parts)?.as_str() {
                    "ACP" => Approach::Positive,
                    "ACN" => Approach::Negative,
                    "AC" => Approach::Absolute,
                    "DC" => Approach::Shortest,
                    across @ ("DAC" | "DIC" | "RAC" | "RIC") => Approach::Across(Across {
                        diameter: across.starts_with('D'),
                        incremental: across.ends_with("IC"),
                    }),
                    _ => Approach::Incremental,
                };
                let value = self.value(due(&mut parts)?)?;
                Ok(NcValue::Approached(approach, Box::new(value)))
            }
            Rule::signed | Rule::hash_value | Rule::expression | Rule::hash_expression => {
                if let Some(number) = plain_number(pair.clone())? {
                    return Ok(NcValue::Number(number));
                }
                Ok(match self.expression(pair)? {
                    NcExpression::Text(text) => NcValue::Text(text),
                    expression => NcValue::Expression(Box::new(expression)),
                })
            }
            _ => Ok(NcValue::Expression(Box::new(self.expression(pair)?))),
        }
    }

    /// Operands and operators in a row.
    fn expression(&self, pair: Pair<'_, Rule>) -> Parsed<NcExpression> {
        let mut tree =
            ExpressionTree::new(if self.hash { Precedence::Hash } else { Precedence::Names });
        let (mut minus, mut not) = (false, false);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::sign => minus = part.as_str() == "-",
                Rule::not => not = true,
                Rule::infix | Rule::hash_infix => tree.operator(part.as_str())?,
                _ => {
                    let mut operand = self.primary(part)?;
                    let signed = minus || not;
                    if minus {
                        operand = NcExpression::Unary(UnaryOperator::Minus, Box::new(operand));
                    }
                    if not {
                        operand = NcExpression::Unary(UnaryOperator::Not, Box::new(operand));
                    }
                    tree.operand(operand, signed);
                    (minus, not) = (false, false);
                }
            }
        }
        tree.finish()
    }

    /// One operand without its sign.
    fn primary(&self, pair: Pair<'_, Rule>) -> Parsed<NcExpression> {
        Ok(match pair.as_rule() {
            Rule::number => NcExpression::Number(number::value(pair.as_str())?),
            Rule::text => NcExpression::Text(self.text(pair)),
            Rule::bracket | Rule::group => self.expression(only(pair))?,
            Rule::hash_variable => self.hash_variable(pair)?,
            Rule::hash_function | Rule::function => {
                let mut parts = pair.into_inner();
                let name = due(&mut parts)?.as_str().to_owned();
                let arguments = parts.map(|part| self.argument(part)).collect::<Parsed<_>>()?;
                NcExpression::Function { name, arguments }
            }
            Rule::indexed => {
                let mut parts = pair.into_inner();
                let name = due(&mut parts)?.as_str().to_owned();
                let first = self.expression(due(&mut parts)?)?;
                if parts.is_empty() {
                    let index = Box::new(first);
                    return Ok(NcExpression::Indexed { name, index });
                }
                let mut arguments = vec![first];
                for part in parts {
                    arguments.push(self.expression(part)?);
                }
                NcExpression::Function { name, arguments }
            }
            _ => NcExpression::Variable(pair.as_str().to_owned()),
        })
    }

    /// An argument of a function; of `ATAN[y]/[x]` the second stands in brackets.
    fn argument(&self, pair: Pair<'_, Rule>) -> Parsed<NcExpression> {
        match pair.as_rule() {
            Rule::bracket => self.expression(only(pair)),
            _ => self.expression(pair),
        }
    }

    /// `#1`, `#<NAME>`, `#[..]`; `##1` is the variable whose number is in `#1`.
    fn hash_variable(&self, pair: Pair<'_, Rule>) -> Parsed<NcExpression> {
        let mut hashes = 0;
        let mut variable = None;
        for part in pair.into_inner() {
            variable = Some(match part.as_rule() {
                Rule::hash => {
                    hashes += 1;
                    continue;
                }
                Rule::whole => {
                    NcExpression::Variable(format!("#{}", number::whole(part.as_str())?))
                }
                Rule::angled => NcExpression::Variable(format!("#{}", angled(part))),
                _ => NcExpression::Indexed {
                    name: "#".to_owned(),
                    index: Box::new(self.expression(only(part))?),
                },
            });
        }
        if hashes > MOST_HASHES {
            let message = format!("more than {MOST_HASHES} `#` in a row");
            return Err(Unreadable::new(message));
        }
        let mut variable = variable.ok_or_else(|| Unreadable::new("a variable is due"))?;
        for _ in 1..hashes {
            variable = NcExpression::Indexed { name: "#".to_owned(), index: Box::new(variable) };
        }
        Ok(variable)
    }

    /// The text in quotation marks, as written.
    fn text(&self, pair: Pair<'_, Rule>) -> String {
        let span = only(pair).as_span();
        self.original[span.start()..span.end()].to_owned()
    }

    fn flow(&self, pair: Pair<'_, Rule>) -> Parsed<NcFlow> {
        let rule = pair.as_rule();
        let spelling = pair.as_str();
        let mut parts = pair.into_inner();
        Ok(match rule {
            Rule::program => {
                NcFlow::Label(format!("O{}", number::whole(due(&mut parts)?.as_str())?))
            }
            Rule::o_text => {
                let o = if spelling.starts_with('O') { "O" } else { "" };
                NcFlow::Label(format!("{o}{}", angled(due(&mut parts)?)))
            }
            Rule::archive | Rule::percent_name => NcFlow::Label(spelling.to_owned()),
            Rule::local_subprogram => {
                return Err(Unreadable::new("a subprogram in the file of its program is not read"));
            }
            Rule::label => NcFlow::Label(due(&mut parts)?.as_str().to_owned()),
            Rule::o_flow => return self.o_flow(parts),
            Rule::hash_if => return self.hash_if(parts),
            Rule::hash_goto => NcFlow::Goto {
                target: self.target(due(&mut parts)?)?,
                direction: JumpDirection::Anywhere,
                condition: None,
            },
            Rule::hash_while => {
                let condition = self.expression(only(due(&mut parts)?))?;
                let name = Some(plain_whole(due(&mut parts)?)?);
                NcFlow::While { name, condition }
            }
            Rule::hash_do => NcFlow::Do(Some(plain_whole(due(&mut parts)?)?)),
            Rule::hash_end => NcFlow::EndWhile(Some(plain_whole(due(&mut parts)?)?)),
            Rule::hash_else => NcFlow::Else(None),
            Rule::hash_endif => NcFlow::EndIf(None),
            Rule::hash_call => NcFlow::Call {
                target: due(&mut parts)?.as_str().to_owned(),
                repeat: None,
                arguments: Vec::new(),
            },
            Rule::if_goto => {
                due(&mut parts)?;
                let condition = Some(self.expression(due(&mut parts)?)?);
                self.goto(due(&mut parts)?, condition)?
            }
            Rule::goto => self.goto_parts(parts, None)?,
            Rule::r#if => {
                due(&mut parts)?;
                NcFlow::If { name: None, condition: self.expression(due(&mut parts)?)? }
            }
            Rule::r#while => {
                due(&mut parts)?;
                NcFlow::While { name: None, condition: self.expression(due(&mut parts)?)? }
            }
            Rule::r#for => {
                due(&mut parts)?;
                let variable = self.primary(due(&mut parts)?)?;
                let from = self.expression(due(&mut parts)?)?;
                due(&mut parts)?;
                let to = self.expression(due(&mut parts)?)?;
                NcFlow::For { variable, from, to }
            }
            Rule::until => {
                due(&mut parts)?;
                NcFlow::Until(self.expression(due(&mut parts)?)?)
            }
            Rule::repeat => NcFlow::Do(None),
            Rule::repeat_from => return self.repeat_from(parts),
            Rule::procedure => {
                due(&mut parts)?;
                NcFlow::SubBegin(due(&mut parts)?.as_str().to_owned())
            }
            Rule::plain_flow => match spelling {
                "ELSE" => NcFlow::Else(None),
                "ENDIF" => NcFlow::EndIf(None),
                "ENDWHILE" => NcFlow::EndWhile(None),
                "ENDFOR" => NcFlow::EndFor,
                "LOOP" => NcFlow::Loop,
                "ENDLOOP" => NcFlow::EndLoop,
                _ => NcFlow::SubEnd(None),
            },
            _ => return Err(Unreadable::new("this cannot be read")),
        })
    }

    /// `IF [..]` and what depends on it.
    fn hash_if(&self, mut parts: Pairs<'_, Rule>) -> Parsed<NcFlow> {
        let condition = self.expression(only(due(&mut parts)?))?;
        let then = due(&mut parts)?;
        Ok(match then.as_rule() {
            Rule::then => NcFlow::Then(condition),
            Rule::if_number => NcFlow::Goto {
                target: NcExpression::Text(then.as_str().to_owned()),
                direction: JumpDirection::Anywhere,
                condition: Some(condition),
            },
            _ => NcFlow::Goto {
                target: self.target(only(then))?,
                direction: JumpDirection::Anywhere,
                condition: Some(condition),
            },
        })
    }

    /// Where `GOTO` leads: a number, something to be worked out, a name.
    fn target(&self, pair: Pair<'_, Rule>) -> Parsed<NcExpression> {
        match pair.as_rule() {
            Rule::name => Ok(NcExpression::Text(pair.as_str().to_owned())),
            _ => self.expression(pair),
        }
    }

    fn goto(&self, pair: Pair<'_, Rule>, condition: Option<NcExpression>) -> Parsed<NcFlow> {
        self.goto_parts(pair.into_inner(), condition)
    }

    fn goto_parts(
        &self,
        mut parts: Pairs<'_, Rule>,
        condition: Option<NcExpression>,
    ) -> Parsed<NcFlow> {
        let direction = match due(&mut parts)?.as_str() {
            "GOTOF" => JumpDirection::Forward,
            "GOTOB" => JumpDirection::Back,
            _ => JumpDirection::Anywhere,
        };
        let target = due(&mut parts)?;
        let target = match target.as_rule() {
            Rule::text => self.text(target).to_ascii_uppercase(),
            _ => target.as_str().to_owned(),
        };
        Ok(NcFlow::Goto { target: NcExpression::Text(target), direction, condition })
    }

    fn repeat_from(&self, mut parts: Pairs<'_, Rule>) -> Parsed<NcFlow> {
        let block_only = due(&mut parts)?.as_str() == "REPEATB";
        let label = due(&mut parts)?.as_str().to_owned();
        let mut until = block_only.then(|| label.clone());
        let mut times = None;
        for part in parts {
            match part.as_rule() {
                Rule::label_name => until = Some(part.as_str().to_owned()),
                _ => times = Some(self.expression(part)?),
            }
        }
        Ok(NcFlow::RepeatFrom { label, until, times })
    }

    /// LinuxCNC's `o` words.
    fn o_flow(&self, mut parts: Pairs<'_, Rule>) -> Parsed<NcFlow> {
        let name = due(&mut parts)?;
        let name = match name.as_rule() {
            Rule::angled => angled(name),
            _ => number::whole(name.as_str())?.to_string(),
        };
        let word = due(&mut parts)?;
        let mut values = parts
            .map(|bracket| self.expression(only(bracket)))
            .collect::<Parsed<Vec<_>>>()?
            .into_iter();
        let missing = || Unreadable::new("a value in brackets is missing behind this word");
        let flow = match word.as_str() {
            "SUB" => NcFlow::SubBegin(name),
            "CALL" => {
                NcFlow::Call { target: name, repeat: None, arguments: values.by_ref().collect() }
            }
            "IF" => NcFlow::If { name: Some(name), condition: values.next().ok_or_else(missing)? },
            "ELSEIF" => {
                NcFlow::ElseIf { name: Some(name), condition: values.next().ok_or_else(missing)? }
            }
            "WHILE" => {
                NcFlow::While { name: Some(name), condition: values.next().ok_or_else(missing)? }
            }
            "REPEAT" => {
                NcFlow::Repeat { name: Some(name), times: values.next().ok_or_else(missing)? }
            }
            "ELSE" => NcFlow::Else(Some(name)),
            "ENDIF" => NcFlow::EndIf(Some(name)),
            "ENDWHILE" => NcFlow::EndWhile(Some(name)),
            "DO" => NcFlow::Do(Some(name)),
            "ENDREPEAT" => NcFlow::EndRepeat(Some(name)),
            "BREAK" => NcFlow::Break(Some(name)),
            "CONTINUE" => NcFlow::Continue(Some(name)),
            // What it hands on stands in `#<_value>`, which is not read.
            "RETURN" => {
                values.next();
                NcFlow::Return(Some(name))
            }
            _ => {
                values.next();
                NcFlow::SubEnd(Some(name))
            }
        };
        if values.next().is_some() {
            let message = "a value too many stands behind this word";
            return Err(Unreadable::new(message));
        }
        Ok(flow)
    }
}

/// `#` in a row.
const MOST_HASHES: usize = 8;

/// `<NAME>`, without blanks.
fn angled(pair: Pair<'_, Rule>) -> String {
    let name = only(pair);
    let mut text = String::from("<");
    text.extend(name.as_str().chars().filter(|each| !matches!(each, ' ' | '\t')));
    text.push('>');
    text
}

fn plain_whole(pair: Pair<'_, Rule>) -> Parsed<String> {
    Ok(number::whole(pair.as_str())?.to_string())
}

/// The number that an expression is, if it is nothing else.
fn plain_number(pair: Pair<'_, Rule>) -> Parsed<Option<NcNumber>> {
    let mut negative = false;
    let mut found = None;
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::sign if found.is_none() => negative = part.as_str() == "-",
            Rule::number if found.is_none() => found = Some(number::number(part.as_str())?),
            _ => return Ok(None),
        }
    }
    Ok(found.map(|number| number.signed(negative)))
}
