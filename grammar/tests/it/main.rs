//! Tests of the readers: CL files, structural codes, expressions.

mod chain;
mod expression;
mod files;
mod reader;
mod statements;
