//! What blocks say, family by family.

use super::{conversational, hash, instructions, names};
use post_grammar::nc::{
    Across, Approach, JumpDirection, NcBlock, NcExpression, NcFlow, NcItem, NcSyntax, NcTerm,
    NcValue, Notation, parse_block,
};

fn block(line: &str, syntax: &NcSyntax) -> NcBlock {
    parse_block(line, syntax).unwrap_or_else(|fault| panic!("{line}: {fault}"))
}

/// A block in short: words as written, names, calls, flow.
fn shown(line: &str, syntax: &NcSyntax) -> String {
    let block = block(line, syntax);
    let mut parts = Vec::new();
    if block.skipped {
        parts.push("/".to_owned());
    }
    if let Some(number) = block.number {
        parts.push(format!("#{number}"));
    }
    parts.extend(block.items.iter().map(item));
    parts.extend(block.remarks.iter().map(|remark| format!("({remark})")));
    parts.join(" ")
}

fn item(item: &NcItem) -> String {
    match item {
        NcItem::Word(word) => {
            let way = if word.incremental { "I:" } else { "" };
            format!("{way}{}={}", char::from(word.letter), value(&word.value))
        }
        NcItem::Named { name, value: given } => format!("{name}:{}", value(given)),
        NcItem::Assign { variable, value } => format!("{}<-{}", tree(variable), tree(value)),
        NcItem::Call { name, arguments } => {
            let arguments = arguments.iter().map(|each| each.as_ref().map_or(String::new(), value));
            format!("{name}({})", arguments.collect::<Vec<_>>().join(","))
        }
        NcItem::Name(name) => format!("`{name}`"),
        NcItem::Number(number) => format!("{}", number.value),
        NcItem::Text(text) => format!("{text:?}"),
        NcItem::Flow(flow) => self::flow(flow),
        NcItem::Statement(terms) => self::terms(terms),
    }
}

fn terms(terms: &[NcTerm]) -> String {
    let shown: Vec<String> = terms
        .iter()
        .map(|term| match term {
            NcTerm::Name(name) => name.clone(),
            NcTerm::Number(number) => format!("<{}>", number.value),
            NcTerm::Text(text) => format!("{text:?}"),
            NcTerm::Group(open, inside) => format!("{}{}", char::from(*open), self::terms(inside)),
            NcTerm::Sign(sign) => char::from(*sign).to_string(),
        })
        .collect();
    shown.join(" ")
}

#[test]
fn statements_of_robots_are_trees_of_their_parts() {
    let syntax = NcSyntax {
        notation: Notation::Statements,
        line_remarks: vec!["!".to_owned()],
        ..NcSyntax::default()
    };
    for (line, said) in [
        (
            "MoveAbsJ [[-1.5,.5,9E9]],v1000\\T:=2.5e-3,fine,tool0; ! there",
            "MOVEABSJ [[<-1.5> , <0.5> , <9000000000> , V1000 \\ T : = <0.0025> , FINE , TOOL0 ; (there)",
        ),
        ("PTP {A1 0,A2 -90}", "PTP {A1 <0> , A2 <-90>"),
        ("here[0] = d2r(5-3)", "HERE [<0> = D2R (<5> - <3>"),
        ("CoolantOn \"Flood\";", "COOLANTON \"Flood\" ;"),
        ("$VEL.CP=0.5", "$VEL.CP = <0.5>"),
        ("here.robax.rax_1:=-2;", "HERE.ROBAX.RAX_1 : = <-2> ;"),
    ] {
        assert_eq!(shown(line, &syntax), said, "{line}");
    }
    for line in ["MoveAbsJ [[0,0", "a)", "(]", "x \"y", "[1,2"] {
        assert!(parse_block(line, &syntax).is_err(), "{line}");
    }
}

fn value(value: &NcValue) -> String {
    match value {
        NcValue::Number(number) => {
            format!("{}{}", number.value, if number.point { "p" } else { "" })
        }
        NcValue::Expression(expression) => tree(expression),
        NcValue::Text(text) => format!("{text:?}"),
        NcValue::Approached(approach, inner) => {
            let name = match approach {
                Approach::Absolute => "AC",
                Approach::Incremental => "IC",
                Approach::Shortest => "DC",
                Approach::Positive => "ACP",
                Approach::Negative => "ACN",
                Approach::Across(Across { diameter: true, incremental: false }) => "DAC",
                Approach::Across(Across { diameter: true, incremental: true }) => "DIC",
                Approach::Across(Across { diameter: false, incremental: false }) => "RAC",
                Approach::Across(Across { diameter: false, incremental: true }) => "RIC",
            };
            format!("{name}({})", self::value(inner))
        }
    }
}

fn tree(expression: &NcExpression) -> String {
    match expression {
        NcExpression::Number(number) => number.to_string(),
        NcExpression::Text(text) => format!("{text:?}"),
        NcExpression::Variable(name) => name.clone(),
        NcExpression::Indexed { name, index } => format!("{name}[{}]", tree(index)),
        NcExpression::Unary(operator, inner) => format!("({operator:?} {})", tree(inner)),
        NcExpression::Binary(operator, left, right) => {
            format!("({} {operator:?} {})", tree(left), tree(right))
        }
        NcExpression::Function { name, arguments } => {
            let arguments: Vec<_> = arguments.iter().map(tree).collect();
            format!("{name}{{{}}}", arguments.join(","))
        }
    }
}

fn flow(flow: &NcFlow) -> String {
    match flow {
        NcFlow::Goto { target, direction, condition } => {
            let direction = match direction {
                JumpDirection::Anywhere => "",
                JumpDirection::Forward => "F",
                JumpDirection::Back => "B",
            };
            let condition =
                condition.as_ref().map_or(String::new(), |each| format!(" if {}", tree(each)));
            format!("goto{direction} {}{condition}", tree(target))
        }
        NcFlow::Then(condition) => format!("then {}", tree(condition)),
        NcFlow::If { name, condition } => format!("if{name:?} {}", tree(condition)),
        NcFlow::While { name, condition } => format!("while{name:?} {}", tree(condition)),
        NcFlow::For { variable, from, to } => {
            format!("for {} {} {}", tree(variable), tree(from), tree(to))
        }
        NcFlow::Call { target, repeat, arguments } => {
            let arguments: Vec<_> = arguments.iter().map(tree).collect();
            let repeat = repeat.as_ref().map_or(String::new(), |each| format!(" x{}", tree(each)));
            format!("call {target}{repeat} {arguments:?}")
        }
        other => format!("{other:?}"),
    }
}

#[test]
fn blocks_of_numbers_and_brackets() {
    for (line, expected) in [
        ("N10 G1 X10. Y-.5 Z+5 F500", "#10 G=1 X=10p Y=-0.5p Z=5 F=500"),
        ("G01Z1.F9.8", "G=1 Z=1p F=9.8p"),
        ("g1 x 10. y - 5", "G=1 X=10p Y=-5"),
        ("g1f1000 z0", "G=1 F=1000 Z=0"),
        ("/N5 G43.4 H1", "/ #5 G=43.4p H=1"),
        ("/3 M1", "/ M=1"),
        ("N20 /M1", "/ #20 M=1"),
        ("O1000 (BRACKET)", "Label(\"O1000\") (BRACKET)"),
        ("O01000", "Label(\"O1000\")"),
        (":1000", "Label(\"O1000\")"),
        ("<BRACKET 5>", "Label(\"<BRACKET5>\")"),
        ("O<BRACKET>", "Label(\"O<BRACKET>\")"),
        ("(debug,B expect: 10   0 2) m1", "M=1 (debug,B expect: 10   0 2)"),
        ("M428 ;TCP:xyzac", "M=428 (TCP:xyzac)"),
        ("G65 P9010 A1. B2.", "G=65 P=9010 A=1p B=2p"),
        ("G187P2E0.1", "G=187 P=2 E=0.1p"),
        ("X10.,R2.", "X=10p ,R:2p"),
        ("#1=5", "#1<-5"),
        ("N10#100=#[#1+2]*-3.5", "#10 #100<-(#[(#1 Add 2)] Multiply (Minus 3.5))"),
        ("##1=1", "#[#1]<-1"),
        ("#<_My Name>=[#<b>-1]", "#<_MYNAME><-(#<B> Subtract 1)"),
        ("#2=ATAN[#1]/[2]+SIN[30]", "#2<-(ATAN{#1,2} Add SIN{30})"),
        ("#3=ATAN[1,2]", "#3<-ATAN{1,2}"),
        ("#4=SQRT[2]/[3]", "#4<-(SQRT{2} Divide 3)"),
        ("#5=2**3**2", "#5<-((2 Power 3) Power 2)"),
        ("#6=1+2*3-4MOD5", "#6<-((1 Add (2 Multiply 3)) Subtract (4 Remainder 5))"),
        ("G1 X#1 Y-#2 Z[#3+1] Axabs", "`AXABS`"),
        ("G1 X#1 Y-#2 Z[#3+1] Aabs[-5]", "G=1 X=#1 Y=(Minus #2) Z=(#3 Add 1) A=ABS{(Minus 5)}"),
        ("IF[#1EQ2]GOTO100", "goto 100 if (#1 Equal 2)"),
        ("IF [#1 GE 2] GOTO #3", "goto #3 if (#1 GreaterOrEqual 2)"),
        ("IF [[#1 GT 2] AND [#2 LT 3]] THEN #3=1", "then ((#1 Greater 2) And (#2 Less 3)) #3<-1"),
        ("IF [VC1 EQ 2] NLAP1", "goto \"NLAP1\" if (VC1 Equal 2)"),
        ("GOTO 100", "goto 100"),
        ("WHILE[#1LT5]DO1", "whileSome(\"1\") (#1 Less 5)"),
        ("END1", "EndWhile(Some(\"1\"))"),
        ("o100 sub", "SubBegin(\"100\")"),
        ("O<lap> CALL [1] [#2+1]", "call <LAP> [\"1\", \"(#2 Add 1)\"]"),
        ("o1 if [#1 GT 0 AND #2 LT 5]", "ifSome(\"1\") ((#1 Greater 0) And (#2 Less 5))"),
        ("o1 while [#1 LT 5]", "whileSome(\"1\") (#1 Less 5)"),
        ("o1 do", "Do(Some(\"1\"))"),
        ("o1 repeat [5]", "Repeat { name: Some(\"1\"), times: Number(5.0) }"),
        ("o1 endrepeat", "EndRepeat(Some(\"1\"))"),
        ("o100 endsub", "SubEnd(Some(\"100\"))"),
        ("CALL O88 PX=1 PH=VC1", "call O88 [] PX:1 PH:VC1"),
        ("G15 H1", "G=15 H=1"),
        ("HL=1 X=5", "HL:1 X=5"),
        ("M98 P1000 L3", "M=98 P=1000 L=3"),
        ("@10 ^45", "@=10 ^=45"),
    ] {
        if expected.is_empty() {
            assert!(parse_block(line, &hash()).is_err(), "{line}");
            continue;
        }
        let shown = shown(line, &hash());
        assert!(shown.ends_with(expected), "{line}: {shown}");
        assert!(shown == expected || line.ends_with("Axabs"), "{line}: {shown}");
    }
}

#[test]
fn blocks_of_names_and_parentheses() {
    for (line, expected) in [
        ("N10 G1 X10 A3=0.5 B3=0 C3=-.5 F500", "#10 G=1 X=10 A3:0.5p B3:0 C3:-0.5p F=500"),
        ("DEF REAL _X, _Y=5", "`DEF REAL` `_X` _Y<-5"),
        ("DEF INT FELD[10]", "`DEF INT` FELD:10"),
        ("DEF STRING[32] NAME", "`DEF STRING` `NAME`"),
        ("_X_HOME=-365. _Y_HOME=224.", "_X_HOME<-(Minus 365) _Y_HOME<-224"),
        ("SUPA G0 Z=_Z_HOME D0", "`SUPA` G=0 Z=_Z_HOME D=0"),
        ("T=\"ENTFRAESER_D8 90GRAD\" M6", "T=\"ENTFRAESER_D8 90GRAD\" M=6"),
        ("MSG(\"Schruppen; (fein)\") ;x", "MSG(\"Schruppen; (fein)\") (x)"),
        ("MSG()", "MSG()"),
        ("CYCLE832(_camtolerance,1,1)", "CYCLE832(_CAMTOLERANCE,1,1)"),
        ("MCALL CYCLE82(50,0.,2,-10,,.5)", "`MCALL` CYCLE82(50,0p,2,-10,,0.5p)"),
        ("CYCLE83(1,2,)", "CYCLE83(1,2,)"),
        ("CYCLE800(0,\"\",100000,57)", "CYCLE800(0,\"\",100000,57)"),
        (
            "G0 A=DC(10) B=ACP(20.5) C=ACN(-1) X=IC(5) Y=AC(R1)",
            "G=0 A=DC(10) B=ACP(20.5p) C=ACN(-1) I:X=5 Y=AC(R1)",
        ),
        ("G2 X1 CR=5 TURN=2 I=AC(3)", "G=2 X=1 CR:5 TURN:2 I=AC(3)"),
        ("X1=10 S2=500 F=R1*2", "X1:10 S2:500 F=(R1 Multiply 2)"),
        ("X1EX-3 Y2.5EX2", "X=0.001 Y=250p"),
        ("R1=5 R2=R1+SIN(30) R[R1]=2", "R1<-5 R2<-(R1 Add SIN{30}) R[R1]<-2"),
        ("R1=5 ORIWKS", "R1<-5 `ORIWKS`"),
        ("FELD[1]=2", "FELD[1]<-2"),
        ("$P_UIFR[1,X,TR]=5", "$P_UIFR{1,X,TR}<-5"),
        ("IF R1>5 GOTOF MARK1", "gotoF \"MARK1\" if (R1 Greater 5)"),
        ("IF (R1==1) AND (R2<>2) GOTOB N10", "gotoB \"N10\" if ((R1 Equal 1) And (R2 NotEqual 2))"),
        ("GOTO END_1", "goto \"END_1\""),
        ("IF R1", "ifNone R1"),
        ("ELSE", "Else(None)"),
        ("ENDIF", "EndIf(None)"),
        ("WHILE R1<5", "whileNone (R1 Less 5)"),
        ("FOR R1=1 TO 5", "for R1 1 5"),
        ("FOR _I = R1 TO R2-1", "for _I R1 (R2 Subtract 1)"),
        ("LOOP", "Loop"),
        ("REPEAT", "Do(None)"),
        ("UNTIL R1==5", "Until(Binary(Equal, Variable(\"R1\"), Number(5.0)))"),
        (
            "REPEAT MARK1 P=3",
            "RepeatFrom { label: \"MARK1\", until: None, times: Some(Number(3.0)) }",
        ),
        (
            "REPEAT MARK1 MARK2",
            "RepeatFrom { label: \"MARK1\", until: Some(\"MARK2\"), times: None }",
        ),
        (
            "REPEATB MARK1 P=2",
            "RepeatFrom { label: \"MARK1\", until: Some(\"MARK1\"), times: Some(Number(2.0)) }",
        ),
        ("N10 MARK1: G1 X5", "#10 Label(\"MARK1\") G=1 X=5"),
        ("PROC LAP", "SubBegin(\"LAP\")"),
        ("RET", "SubEnd(None)"),
        ("L100 P3", "L=100 P=3"),
        ("WENDEN_1", "`WENDEN_1`"),
        ("TRAORI(1)", "TRAORI(1)"),
        ("ROT RPL=45", "`ROT` RPL:45"),
        ("AROT Z=R1", "`AROT` Z=R1"),
        ("%_N_BRACKET_MPF", "Label(\"%_N_BRACKET_MPF\")"),
        (";$PATH=/_N_MPF_DIR", "($PATH=/_N_MPF_DIR)"),
        (":20 G0", "#20 G=0"),
        ("M=R1", "M=R1"),
        ("X=-R1", "X=(Minus R1)"),
        ("MSG(\"A\"<<R1)", "MSG((\"A\" Join R1))"),
        ("STOPRE", "`STOPRE`"),
    ] {
        assert_eq!(shown(line, &names()), expected, "{line}");
    }
}

#[test]
fn conversational_blocks() {
    for (line, expected) in [
        ("0 BEGIN PGM Teil_1 MM", "#0 `BEGIN PGM` \"Teil_1\" `MM`"),
        ("99 END PGM Teil_1 INCH", "#99 `END PGM` \"Teil_1\" `INCH`"),
        ("5 L X+10 IY-5.5 R0 FMAX M91", "#5 `L` X=10 I:Y=-5.5p `R0` `FMAX` M=91"),
        ("5 L  A+Q120  C+Q122 F MAX", "#5 `L` A=Q120 C=Q122 `FMAX`"),
        ("5 L X-Q1 FQ206", "#5 `L` X=(Minus Q1) F=Q206"),
        (
            "6 LN X+1 Y+2 Z+3 NX+0 NY+0 NZ+1 TX+0.5 TY-.5 TZ+.5 F500",
            "#6 `LN` X=1 Y=2 Z=3 NX:0 NY:0 NZ:1 TX:0.5p TY:-0.5p TZ:0.5p F=500",
        ),
        ("7 CC X+1 Y+2", "#7 `CC` X=1 Y=2"),
        ("7 CC", "#7 `CC`"),
        ("8 C X+1 Y+2 DR-", "#8 `C` X=1 Y=2 `DR-`"),
        ("8 CR X+1 R+10 DR+ F500", "#8 `CR` X=1 R=10 `DR+` F=500"),
        ("8 CT X+1 Y+2", "#8 `CT` X=1 Y=2"),
        ("9 CP IPA+360 IZ-5 DR+", "#9 `CP` IPA:360 I:Z=-5 `DR+`"),
        ("9 LP PR+10 PA+30 RL", "#9 `LP` PR:10 PA:30 `RL`"),
        ("9 RND R5 F100", "#9 `RND` R=5 F=100"),
        ("9 CHF 2", "#9 CHF:2"),
        (
            "10 TOOL CALL 5 Z S2786 F100 DL+0.1 DR-0.2",
            "#10 `TOOL CALL` 5 `Z` S=2786 F=100 DL:0.1p DR:-0.2p",
        ),
        ("10 TOOL CALL \"Fraeser D10\" Z S500", "#10 `TOOL CALL` \"Fraeser D10\" `Z` S=500"),
        ("10 TOOL  CALL S500", "#10 `TOOL CALL` S=500"),
        ("10 TOOL DEF 6", "#10 `TOOL DEF` 6"),
        ("11 CYCL DEF 247 DATUM SETTING Q339=+1", "#11 `CYCL DEF` 247 \"DATUM SETTING\" Q339:1"),
        ("11 CYCL DEF 7.0 Nullpunkt", "#11 `CYCL DEF` 7 \"Nullpunkt\""),
        ("11 CYCL DEF 7.1  IX+5", "#11 `CYCL DEF` 7.1 I:X=5"),
        ("11 CYCL DEF 7.1 #5", "#11 `CYCL DEF` 7.1 #:5"),
        ("11 CYCL DEF 8.1 X Y", "#11 `CYCL DEF` 8.1 `X` `Y`"),
        ("11 CYCL DEF 8.1", "#11 `CYCL DEF` 8.1"),
        ("11 CYCL DEF 10.1 ROT+45", "#11 `CYCL DEF` 10.1 ROT:45"),
        ("11 CYCL DEF 11.1 SCL 1.5", "#11 `CYCL DEF` 11.1 SCL:1.5p"),
        ("11 CYCL DEF 9.1 DWELL 0.5", "#11 `CYCL DEF` 9.1 DWELL:0.5p"),
        ("11 CYCL DEF 9.1 V.ZEIT 0.5", "#11 `CYCL DEF` 9.1 V.ZEIT:0.5p"),
        ("11 CYCL DEF 32.1 T0.01", "#11 `CYCL DEF` 32.1 T=0.01p"),
        ("11 CYCL DEF 32.2 HSC-MODE:0 TA0.5", "#11 `CYCL DEF` 32.2 HSC-MODE:0 TA:0.5p"),
        (
            "11 CYCL DEF 19.1 A+0 B+45 C+0 F500 ABST50",
            "#11 `CYCL DEF` 19.1 A=0 B=45 C=0 F=500 ABST:50",
        ),
        ("12 CYCL CALL M3", "#12 `CYCL CALL` M=3"),
        ("12 CYCL CALL POS X+1", "#12 `CYCL CALL POS` X=1"),
        (
            "13 PLANE SPATIAL SPA+0 SPB+45 SPC-90 TURN MB MAX FMAX SEQ- COORD ROT",
            "#13 `PLANE SPATIAL` SPA:0 SPB:45 SPC:-90 `TURN` `MB MAX` `FMAX` `SEQ-` `COORD ROT`",
        ),
        (
            "13 PLANE SPATIAL SPA+0 SPB+0 SPC+0 TURN DIST50 F500 SYM+ TABLE ROT",
            "#13 `PLANE SPATIAL` SPA:0 SPB:0 SPC:0 `TURN` DIST:50 F=500 `SYM+` `TABLE ROT`",
        ),
        ("13 PLANE RESET STAY", "#13 `PLANE RESET` `STAY`"),
        ("14 M140 MB MAX F99999", "#14 M=140 `MB MAX` F=99999"),
        ("14 M128 F1000", "#14 M=128 F=1000"),
        (
            "15 FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS",
            "#15 `FUNCTION TCPM` `F TCP` `AXIS POS` `PATHCTRL AXIS`",
        ),
        ("15 FUNCTION RESET TCPM", "#15 `FUNCTION RESET TCPM`"),
        ("16 LBL 500", "#16 Label(\"500\")"),
        ("16 LBL \"Bohren\"", "#16 Label(\"BOHREN\")"),
        ("16 LBL 0", "#16 LabelEnd"),
        ("17 CALL LBL 5 REP 2", "#17 call 5 x2 []"),
        ("17 CALL LBL \"Bohren\"", "#17 call BOHREN []"),
        ("17 CALL PGM TNC:\\Teil.H", "#17 CallProgram(\"TNC:\\\\Teil.H\")"),
        ("18 FN 0: Q1 = +5", "#18 Q1<-5"),
        ("18 FN 4: Q1 = +Q2 DIV +4", "#18 Q1<-(Q2 Divide 4)"),
        ("18 FN 5: Q1 = SQRT +4", "#18 Q1<-SQRT{4}"),
        ("18 FN 13: Q1 = +10 ANG -Q2", "#18 Q1<-ANG{10,(Minus Q2)}"),
        ("18 FN 9: IF +Q1 EQU +5 GOTO LBL 3", "#18 goto \"3\" if (Q1 Equal 5)"),
        ("18 FN 12: IF +Q1 LT +Q2 GOTO LBL \"Ende\"", "#18 goto \"ENDE\" if (Q1 Less Q2)"),
        (
            "19 Q1 = Q2 * SIN Q3 + (Q4 - 5) ^ 2",
            "#19 Q1<-((Q2 Multiply SIN{Q3}) Add ((Q4 Subtract 5) Power 2))",
        ),
        ("19 Q1 = - SQRT 4 / PI", "#19 Q1<-((Minus SQRT{4}) Divide PI)"),
        ("19 QS1 = \"Text\"", "#19 QS1<-\"Text\""),
        ("20 STOP M6", "#20 `STOP` M=6"),
        ("20 BLK FORM 0.1 Z X+0 Y+0 Z-40", "#20 `BLK FORM` 0.1 `Z` X=0 Y=0 Z=-40"),
        ("20 * - Tasche", "#20 (Tasche)"),
        ("20 ; Tue", "#20 (Tue)"),
        ("21 TRANS DATUM AXIS X+10 Y+20", "#21 `TRANS DATUM` `AXIS` X=10 Y=20"),
        ("21 TRANS DATUM RESET", "#21 `TRANS DATUM` `RESET`"),
        ("22 L X+1 R0", "#22 `L` X=1 `R0`"),
        ("/23 L X+1", "/ #23 `L` X=1"),
        ("24 G91 G28 Z0.", "#24 G=91 G=28 Z=0p"),
        ("m30", "M=30"),
    ] {
        assert_eq!(shown(line, &conversational()), expected, "{line}");
    }
}

#[test]
fn blocks_of_controls_with_instructions() {
    for (line, expected) in [
        ("N10 #RTCP ON", "#10 `#RTCP ON`"),
        ("#rtcp  off", "`#RTCP OFF`"),
        ("N20 #MCS G0 Z0.", "#20 `#MCS` G=0 Z=0p"),
        ("#CS ON[0,0,10,,,45]", "#CS ON(0,0,10,,,45)"),
        (
            "#CS ON [1] [Mode 1, 0, -2.5, P1, 30, 0, 0]",
            "#CS ON(\"[1]\",\"MODE 1\",0,-2.5p,P1,30,0,0)",
        ),
        ("#KIN ID [91]", "#KIN ID(91)"),
        ("#MCS ON [EX TOOL]", "#MCS ON(\"EX TOOL\")"),
        ("#HSC ON [PATH_DEV=0.02 TRACK_DEV=1]", "#HSC ON(\"PATH_DEV=0.02 TRACK_DEV=1\")"),
        ("#MSG [\"Now, turn [it]\"] ; by hand", "#MSG(\"Now, turn [it]\") (by hand)"),
        ("G159=7 X1 (there)", "G159:7 X=1 (there)"),
        ("G1 X[P1+2.] F=P2", "G=1 X=(P1 Add 2) F=P2"),
        ("%1000 (PART)", "Label(\"%1000\") (PART)"),
        ("%Part_1.nc", "Label(\"%PART_1.NC\")"),
    ] {
        assert_eq!(shown(line, &instructions()), expected, "{line}");
    }
    let refused = |line: &str, syntax: &NcSyntax| parse_block(line, syntax).unwrap_err().message;
    assert!(refused("%L POCKET", &instructions()).contains("a subprogram"));
    // Of other families these are no blocks.
    for line in ["#RTCP ON", "%1000"] {
        for syntax in [hash(), names()] {
            refused(line, &syntax);
        }
    }
    for line in ["#1=5", "#X", "#CS ON [1", "#CS ON [1]]", "$IF P1 == 2"] {
        refused(line, &instructions());
    }
}

#[test]
fn what_is_refused_says_where() {
    for (line, syntax, span, message) in [
        ("X10 20", hash(), 4..5, "a number without a letter"),
        ("X", hash(), 1..1, "the block ends where a value is due"),
        ("G1 X(1)Y=", hash(), 7..8, "a number is due, not `Y`"),
        ("G1 (REMARK", hash(), 3..4, "a remark begins with this `(` and has no end"),
        ("G1 (A (B) X5)", hash(), 6..7, "a remark within a remark"),
        ("G1 X1)", hash(), 5..6, "this `)` closes nothing"),
        ("X[1+2", hash(), 5..5, "the block ends where a value is due"),
        (
            "#1=1 AND 2+3",
            hash(),
            0..12,
            "controls do not agree which of these operators binds first",
        ),
        (
            "#1=#2 EQ 1 AND #3 OR #4",
            hash(),
            0..23,
            "controls do not agree which of these operators binds first",
        ),
        (
            "IF R1==1 AND R2==2 GOTOF MARK",
            names(),
            0..29,
            "controls do not agree which of these operators binds first",
        ),
        ("#1=-2**2", hash(), 0..8, "controls do not agree which of these operators binds first"),
        ("R1=5\u{1}", names(), 4..5, "byte 0x01 belongs to no program"),
        ("18 FN 1: Q1 = +5", conversational(), 3..16, "FN 1 is not this function: that is FN 0"),
        ("18 FN 18: SYSREAD Q1 = ID270", conversational(), 10..11, "`S` does not belong here"),
        ("5 L X+", conversational(), 6..6, "the block ends where a value is due"),
    ] {
        let fault = parse_block(line, &syntax).expect_err(line);
        let found = (fault.message.as_str(), fault.span.clone());
        assert_eq!(found, (message, span), "{line}");
    }
}
