//! Tests of the readers: CL files, structural codes, expressions, templates.

mod chain;
mod expression;
mod files;
mod nc;
mod points;
mod reader;
mod statements;
mod template;
mod units;
