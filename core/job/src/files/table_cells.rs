//! Lines of a table of text: cells apart by `,`, `;` or tabs.

/// What keeps cells apart: the sign of the heads that stands there most often.
pub fn separator(head: &str) -> char {
    let mut best = (0, ',');
    for sign in [',', ';', '\t'] {
        let count = head.matches(sign).count();
        if count > best.0 {
            best = (count, sign);
        }
    }
    best.1
}

/// The cells of a line; one in quotes may hold what keeps cells apart.
pub fn cells(text: &str, separator: char) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut signs = text.chars().peekable();
    while let Some(sign) = signs.next() {
        let Some(cell) = cells.last_mut() else { break };
        match sign {
            '"' if quoted && signs.peek() == Some(&'"') => {
                signs.next();
                cell.push('"');
            }
            '"' => quoted = !quoted,
            sign if sign == separator && !quoted => cells.push(String::new()),
            sign => cell.push(sign),
        }
    }
    cells.into_iter().map(|cell| cell.trim().to_owned()).collect()
}
