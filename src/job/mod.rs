//! A CL file, a machine and its plugins.

pub mod machine_files;
pub mod plugin_finder;
