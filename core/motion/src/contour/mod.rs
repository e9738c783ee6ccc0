//! The contour error: how far the tool is off its path, and what part of that comes from where.
