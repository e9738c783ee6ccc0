//! A program held against a course.
