//! What a program did, as a CL file.
