use post_machine::program_text::{Facts, OperationFacts, ProgramFacts, TextTemplate, ToolFacts};

fn facts() -> Facts {
    let tool = |number: u32| ToolFacts {
        number,
        register: number,
        name: format!("MILL {number}"),
        diameter: Some(12.5),
        ..ToolFacts::default()
    };
    Facts {
        program: ProgramFacts {
            name: "PART".to_owned(),
            tools: Some(vec![tool(1), tool(7)]),
            time: Some(3723.4),
            ..ProgramFacts::default()
        },
        tool: Some(tool(7)),
        operation: Some(OperationFacts {
            name: "A) M30 (\u{2028}B".to_owned(),
            number: 2,
            ..OperationFacts::default()
        }),
        ..Facts::default()
    }
}

fn filled(source: &str) -> Result<Vec<String>, String> {
    let template = TextTemplate::parse(source).map_err(|fault| fault.message)?;
    template.lines(&facts()).map_err(|fault| fault.message)
}

#[test]
fn facts_become_lines() {
    for (source, lines) in [
        ("T{{ tool.number }} M6", &["T7 M6"][..]),
        ("({{ program.name|lower }})\n\n  \nG90 ", &["(part)", "G90"]),
        (
            "{% for tool in program.tools %}\n(T{{ tool.number }} D{{ tool.diameter|fixed(3) }})\n{% endfor %}",
            &["(T1 D12.500)", "(T7 D12.500)"],
        ),
        ("{% if tool.length is none %}G4\n{% else %}Z{{ tool.length }}\n{% endif %}", &["G4"]),
        ("H{{ tool.number + 20 }}", &["H27"]),
        ("({{ program.time|clock }})", &["(1:02:03)"]),
        ("{{ -0.0001|fixed(2) }}", &["0.00"]),
        ("(**** {# nothing #} ****)", &["(****  ****)"]),
        // A name of the CL file stays what it is: a text in a remark.
        ("(OP {{ operation.name }})", &["(OP A  M30   B)"]),
    ] {
        assert_eq!(filled(source).unwrap(), lines, "{source}");
    }
}

#[test]
fn what_is_not_known_is_no_empty_place() {
    for (source, why) in [
        ("{{ tool.length }}", "not known here"),
        ("{{ tool.lenght }}", "undefined"),
        ("{{ nothing }}", "undefined"),
        ("{{ last_tool.number }}", "undefined"),
        ("{{ program.tools }}", "only numbers and texts"),
        ("{{ tool.number", "syntax error"),
        ("{% if tool %}", "syntax error"),
        ("{{ tool.number|frob }}", "unknown filter"),
    ] {
        let told = filled(source).expect_err(source);
        assert!(told.contains(why), "{source}: {told}");
    }
}

/// A file may come from a stranger, and a few dozen instructions would fill the memory.
#[test]
fn no_template_works_without_end() {
    let many = "{% for a in program.tools %}".repeat(40) + "X" + &"{% endfor %}".repeat(40);
    for source in [
        "{% set x = 'a' %}",
        "{% set x %}a{% endset %}",
        "{% with x = 1 %}{% endwith %}",
        "{% macro m() %}{% endmacro %}",
        "{% for a in [1, 2] %}{% endfor %}",
        "{% for a in program.tools recursive %}{% endfor %}",
        "{% for a in program.name~program.name %}{% endfor %}",
        "{%- for a in range(9) %}{% endfor %}",
        "{{ 'a' * 1000000 }}",
        "{{ '}}' ~ 'a' * 9 }}",
        "{% raw %}{% endraw %}",
        "{% include 'x' %}",
        "{% filter upper %}{% endfilter %}",
        many.as_str(),
        &"x".repeat((1 << 14) + 1),
    ] {
        assert!(filled(source).is_err(), "{}", &source[..source.len().min(60)]);
    }
    // The place is that of the fault.
    let fault = TextTemplate::parse("G0\n{{ tool.number }}{% set x = 1 %}").unwrap_err();
    assert_eq!(fault.span, Some(22..33));
}
