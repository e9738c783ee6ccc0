//! Lines of a table: what stands between their columns, and which of them are rows.

/// What stands between the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// `;`
    Semicolon,
    /// A tab.
    Tab,
    /// `,`: numbers have a point.
    Comma,
    /// Any number of blanks.
    Blanks,
}

impl Separator {
    /// Of a line, by the first of these that it has; a comma between numbers that are apart by blanks is a decimal sign.
    pub fn of(line: &str) -> Self {
        let line = line.trim();
        if line.contains(';') {
            Self::Semicolon
        } else if line.contains('\t') {
            Self::Tab
        } else if line.contains(',') {
            let numbers = |separator: Self| {
                let fields = separator.fields(line);
                fields.len() > 1 && fields.iter().all(|field| separator.is_number(field))
            };
            match numbers(Self::Blanks) && !numbers(Self::Comma) {
                true => Self::Blanks,
                false => Self::Comma,
            }
        } else {
            Self::Blanks
        }
    }

    /// What stands between the separators; nothing behind the last of them.
    pub fn fields(self, line: &str) -> Vec<&str> {
        let letter = match self {
            Self::Blanks => return line.split_whitespace().collect(),
            Self::Semicolon => ';',
            Self::Tab => '\t',
            Self::Comma => ',',
        };
        let line = line.trim_matches(['\r', '\n', ' ']);
        let line = line.strip_suffix(letter).unwrap_or(line);
        let fields = line.split(letter);
        fields.map(|field| field.trim().trim_matches('"')).collect()
    }

    /// A number; one that is not finite is told apart from what is none.
    pub fn number(self, field: &str) -> Option<f64> {
        if self != Self::Comma && field.contains(',') {
            return field.replacen(',', ".", 1).parse().ok();
        }
        field.parse().ok()
    }

    fn is_number(self, field: &str) -> bool {
        self.number(field).is_some()
    }

    /// A line of so many fields is a row, and not of the head: one field at least is a number, and of the others most are
    /// numbers or empty. Names may be numbers here and there, and rows may have remarks.
    pub fn is_row(self, fields: &[&str]) -> bool {
        let numbers = fields.iter().filter(|field| self.is_number(field)).count();
        let empty = fields.iter().filter(|field| field.is_empty()).count();
        numbers > 0 && 2 * (numbers + empty) > fields.len()
    }
}

/// Digits behind the decimal sign of a number that is written without exponent.
pub fn decimals(field: &str) -> Option<i32> {
    if field.contains(['e', 'E']) {
        return None;
    }
    let behind = field.split(['.', ',']).nth(1).unwrap_or_default();
    i32::try_from(behind.len()).ok()
}
