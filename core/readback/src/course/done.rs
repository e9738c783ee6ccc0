//! What a program did, as a course.
