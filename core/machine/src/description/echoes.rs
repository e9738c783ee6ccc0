//! Faults of a machine file that only repeat another one.

use super::layers::MachineSources;
use crate::diagnostic::Diagnostic;

/// Keeps those of the faults `found` that stand on their own, and do not repeat one of `hiding`.
///
/// What could not be read is missing where it stands: whatever is said of its table may be its echo, and what is said of
/// the chain, which all tables make together, too.
pub(super) fn own(
    found: Vec<Diagnostic>,
    hiding: &[Diagnostic],
    sources: &MachineSources,
) -> Vec<Diagnostic> {
    let tables: Vec<_> = hiding.iter().map(|fault| sources.table_of(fault)).collect();
    // A machine file that extends another, or a setting, says a key of a table whose other keys stand there.
    let names: Vec<&str> = hiding.iter().filter_map(|fault| sources.table_name(fault)).collect();
    // A parameter may be missing, so that an expression that names one says nothing.
    let parameters = tables.iter().flatten();
    let mut parameters = parameters.filter(|(_, _, header)| header.contains("parameters"));
    let lacks_parameters = parameters.next().is_some();
    let own = found.into_iter().filter(|fault| {
        let table = sources.table_of(fault);
        let in_a_table = table.is_some_and(|(_, header, _)| header > 0);
        let echoes = match fault.code {
            "machine-chain" => true,
            "machine-expression" => lacks_parameters,
            _ => false,
        };
        let name = sources.table_name(fault);
        let layered = name.is_some_and(|name| names.iter().any(|hiding| is_within(hiding, name)));
        in_a_table && !echoes && !layered && !tables.contains(&table)
    });
    own.collect()
}

/// The table `name` is `outer`, or one of its own: `axis.C` of `axis`.
fn is_within(name: &str, outer: &str) -> bool {
    let rest = name.strip_prefix(outer);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}
