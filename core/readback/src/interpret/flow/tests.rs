//! Small programs of each language: the order in which their blocks are run.

use std::io::Cursor;

use post_grammar::nc::{NcSyntax, NcValue, Notation};

use super::*;

/// Values of X of the blocks in the order in which they are run, and what stopped it.
fn run_with(language: Language, program: &str, limits: Limits) -> (Vec<f64>, Option<String>) {
    let names = language == Language::Names;
    let syntax = NcSyntax {
        notation: match language {
            Language::Conversational => Notation::Conversational,
            Language::Joints => Notation::Statements,
            _ => Notation::Words,
        },
        line_remarks: vec![";".to_owned()],
        semicolon_ends: false,
        enclosed_remarks: (!names && language != Language::Conversational).then_some(('(', ')')),
        hash_variables: matches!(language, Language::Macro | Language::Rs274),
        instructions: language == Language::Instructions,
    };
    let reader = NcReader::new(Cursor::new(program.as_bytes().to_vec()), syntax);
    let mut flow = ProgramFlow::new(reader, language, limits, "test.nc");
    let mut variables = Variables::new(language);
    let mut block = NcBlock::default();
    let mut seen = Vec::new();
    loop {
        match flow.next(&mut variables, &mut block) {
            Ok(true) => {}
            Ok(false) => return (seen, None),
            Err(fault) => return (seen, Some(fault.message)),
        }
        for item in &block.items {
            let NcItem::Word(word) = item else {
                continue;
            };
            if word.letter == b'X' {
                match variables.worth(&word.value) {
                    Ok(value) => seen.push(value),
                    Err(fault) => return (seen, Some(fault.message)),
                }
            }
            let ends =
                |value: &NcValue| matches!(value, NcValue::Number(number) if number.value == 30.0);
            if word.letter == b'M' && ends(&word.value) {
                return (seen, None);
            }
        }
    }
}

fn run(language: Language, program: &str) -> Vec<f64> {
    let (seen, fault) = run_with(language, program, Limits::default());
    assert_eq!(fault, None, "{seen:?}");
    seen
}

#[test]
fn macros_loop_jump_and_call() {
    let program = "O1000\n#1=0\nWHILE [#1 LT 3] DO1\nG1 X#1\n#1=#1+1\nEND1\nIF [#1 EQ 3] GOTO 20\nX99\nN20 X10\n\
                   M98 P2000 L2\nG65 P3000 A7. X8.\nX11\nM30\nO2000\nX20\nM99\nO3000\nX#1\nX#24\nM99\n";
    assert_eq!(run(Language::Macro, program), [0.0, 1.0, 2.0, 10.0, 20.0, 20.0, 7.0, 8.0, 11.0]);
}

#[test]
fn a_block_is_run_before_it_calls() {
    assert_eq!(run(Language::Macro, "O1\nX1 M98 P2\nX3\nM30\nO2\nX2\nM99\n"), [1.0, 2.0, 3.0]);
    // Haas: a part of the same program.
    assert_eq!(
        run(Language::Macro, "O1\nM97 P100 L2\nX3\nM30\nN100 X1\nX2\nM99\n"),
        [1.0, 2.0, 1.0, 2.0, 3.0]
    );
    // Back to a block of the caller.
    assert_eq!(run(Language::Macro, "O1\nM98 P2\nX3\nN50 X4\nM30\nO2\nX2\nM99 P50\n"), [2.0, 4.0]);
}

#[test]
fn words_are_read_before_the_block_sets_variables() {
    assert_eq!(run(Language::Rs274, "#3=15\n#3=20 G1 X#3\nX#3\nM30\n"), [15.0, 20.0]);
    assert_eq!(
        run(
            Language::Macro,
            "#3=1\nIF [#3 EQ 1] THEN #3=5\nX#3\nIF [#3 EQ 1] THEN #3=6\nX#3\nM30\n"
        ),
        [5.0, 5.0]
    );
}

#[test]
fn o_words_branch_loop_and_call() {
    let program = "o100 sub\nX#1\n#1=77\no100 endsub\n#1=5\no1 if [#1 gt 4]\nX1\no1 elseif [#1 gt 3]\nX2\no1 else\nX3\no1 endif\n\
                   o2 repeat [2]\nX4\no2 endrepeat\no3 do\n#1=[#1-1]\nX#1\no3 while [#1 gt 3]\no100 call [42]\nX#1\n\
                   o4 while [1]\n#1=[#1+1]\no4 break\no4 endwhile\nX#1\nM30\n";
    assert_eq!(run(Language::Rs274, program), [1.0, 4.0, 4.0, 4.0, 3.0, 42.0, 3.0, 4.0]);
}

/// What a subprogram hands on is no reason to refuse it; who reads it is told that it is not known.
#[test]
fn subprograms_hand_on_a_value() {
    let program = "o100 sub\nX#1\no1 if [#1 gt 4]\no100 return [#1 * 2]\no1 endif\nX9\no100 endsub [7]\n\
                   o100 call [5]\no100 call [3]\nX1\nM30\n";
    assert_eq!(run(Language::Rs274, program), [5.0, 3.0, 9.0, 1.0]);
    let program = program.replace("X1\n", "X#<_value>\n");
    let fault = run_with(Language::Rs274, &program, Limits::default()).1.unwrap();
    assert!(fault.to_uppercase().contains("#<_VALUE>"), "{fault}");
}

#[test]
fn branches_and_loops_of_names() {
    let program = "DEF REAL _A, _B=2.5\nDEF INT N_C\nR1=1\nN_C=2.4\nIF R1==1\nX1\nELSE\nX2\nENDIF\nIF R1>1\nX3\nELSE\nX4\nENDIF\n\
                   FOR R2=1 TO 3\nX=R2\nENDFOR\nREPEAT\nR1=R1+1\nUNTIL R1>=4\nX=R1\nX=_B\nX=_A\nX=N_C\n\
                   IF R1>3 GOTOF ENDE\nX98\nENDE: X5\nGOTOB ZURUECK\nX97\nM30\n";
    let program = program.replace("GOTOB ZURUECK\n", "");
    assert_eq!(
        run(Language::Names, &program),
        [1.0, 4.0, 1.0, 2.0, 3.0, 4.0, 2.5, 0.0, 2.0, 5.0, 97.0]
    );
    let part = "X1\nTEIL: X2\nX3\nREPEAT TEIL P=2\nX4\nM30\n";
    assert_eq!(run(Language::Names, part), [1.0, 2.0, 3.0, 2.0, 3.0, 2.0, 3.0, 4.0]);
    let part = "A1: X1\nE1: X2\nX3\nREPEAT A1 E1 P=1\nX4\nM30\n";
    assert_eq!(run(Language::Names, part), [1.0, 2.0, 3.0, 1.0, 2.0, 4.0]);
}

#[test]
fn what_does_not_end_is_refused_after_a_count() {
    let limits = Limits { blocks: 1000, depth: 8 };
    for program in ["O1\nN10 X1\nGOTO 10\n", "O1\nWHILE [1 EQ 1] DO1\nX1\nEND1\n", "O1\nM98 P1\n"] {
        let (seen, fault) = run_with(Language::Macro, program, limits);
        assert!(fault.is_some() && seen.len() <= 1000, "{program}");
    }
    let (_, fault) = run_with(Language::Macro, "O1\nX1\nM99\n", limits);
    assert!(fault.unwrap().contains("without end"));
}

#[test]
fn what_is_not_in_the_file_is_refused_by_name() {
    let fault = |language, program| run_with(language, program, Limits::default()).1.unwrap();
    assert!(fault(Language::Macro, "O1\nM98 P8000\nM30\n").contains("O8000"));
    assert!(fault(Language::Macro, "O1\nGOTO 77\nM30\n").contains("N77"));
    assert!(fault(Language::Macro, "O1\nX#5\nM30\n").contains("#5"));
    assert!(fault(Language::Macro, "O1\nG66 P8000\nM30\n").contains("G66"));
    assert!(fault(Language::Rs274, "o<other> call\nM30\n").to_uppercase().contains("OTHER"));
    assert!(fault(Language::Names, "R1=$P_TOOLNO\nM30\n").contains("$P_TOOLNO"));
}

#[test]
fn loops_that_were_left_do_not_pile_up() {
    let program = "O1\n#2=0\nN5 #1=0\nWHILE [#1 LT 9] DO1\n#1=#1+1\nIF [#1 EQ 2] GOTO 50\nEND1\nN50 #2=#2+1\nX#2\nIF [#2 LT 100] GOTO 5\nM30\n";
    let (seen, fault) = run_with(Language::Macro, program, Limits { blocks: 100_000, depth: 4 });
    assert_eq!((seen.len(), fault), (100, None));
}
