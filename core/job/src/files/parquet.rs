//! Parquet files of flat tables: what analysis tools read columns from.
//!
//! Three kinds of columns, each value there or not; plain encoding, definition levels bit-packed, no compression, row groups
//! of a fixed number of rows. The same table gives the same bytes, in every version of `post`: nothing in a file depends on
//! a library or tells who wrote it when. (The crate `parquet` without arrow brings 34 further crates, which took 108 s of
//! processor time to compile, against this page.)
//!
//! The format: <https://parquet.apache.org/docs/file-format/>; its headers are structs of Thrift's compact protocol.

/// Rows of a group: a page of them fits into any memory.
const GROUP: usize = 1 << 16;

const MAGIC: &[u8] = b"PAR1";

/// A column.
pub struct ParquetColumn<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its values.
    pub values: ParquetValues<'a>,
}

/// The values of a column; none where a row has none.
pub enum ParquetValues<'a> {
    /// DOUBLE.
    Numbers(&'a [Option<f64>]),
    /// INT64.
    Integers(&'a [Option<i64>]),
    /// BYTE_ARRAY of UTF-8.
    Texts(&'a [Option<String>]),
}

/// Numbers of the format.
mod word {
    pub const INT64: i32 = 2;
    pub const DOUBLE: i32 = 5;
    pub const BYTE_ARRAY: i32 = 6;
    pub const OPTIONAL: i32 = 1;
    pub const UTF8: i32 = 0;
    pub const PLAIN: i32 = 0;
    pub const RLE: i32 = 3;
    pub const UNCOMPRESSED: i32 = 0;
    pub const DATA_PAGE: i32 = 0;
}

impl ParquetValues<'_> {
    fn word(&self) -> i32 {
        match self {
            Self::Numbers(_) => word::DOUBLE,
            Self::Integers(_) => word::INT64,
            Self::Texts(_) => word::BYTE_ARRAY,
        }
    }

    /// The page of some rows: which of them have a value, then the values.
    fn page(&self, rows: std::ops::Range<usize>) -> Vec<u8> {
        match self {
            Self::Numbers(numbers) => page(&numbers[rows], |number, page| {
                page.extend(number.to_le_bytes());
            }),
            Self::Integers(integers) => page(&integers[rows], |integer, page| {
                page.extend(integer.to_le_bytes());
            }),
            Self::Texts(texts) => page(&texts[rows], |text, page| {
                page.extend(length(text.len()).to_le_bytes());
                page.extend(text.as_bytes());
            }),
        }
    }
}

fn page<T>(rows: &[Option<T>], put: impl Fn(&T, &mut Vec<u8>)) -> Vec<u8> {
    let mut levels = Thrift::default();
    // One run of groups of eight bits, the first row in the lowest.
    levels.varint((rows.len().div_ceil(8) as u64) << 1 | 1);
    for eight in rows.chunks(8) {
        let bits = eight.iter().enumerate();
        let bits = bits.map(|(place, value)| u8::from(value.is_some()) << place);
        levels.bytes.push(bits.fold(0, |all, bit| all | bit));
    }
    let mut page = Vec::new();
    page.extend(length(levels.bytes.len()).to_le_bytes());
    page.extend(levels.bytes);
    for value in rows.iter().flatten() {
        put(value, &mut page);
    }
    page
}

/// A length in four bytes: no page of a group comes near their end.
fn length(bytes: usize) -> u32 {
    u32::try_from(bytes).unwrap_or(u32::MAX)
}

/// The file of a table with so many rows.
pub fn bytes(rows: usize, columns: &[ParquetColumn<'_>]) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    let mut groups = Vec::new();
    for begin in (0..rows).step_by(GROUP) {
        let group = begin..rows.min(begin + GROUP);
        let chunks = columns.iter().map(|column| {
            let page = column.values.page(group.clone());
            let head = page_header(page.len(), group.len());
            let chunk = Chunk { offset: file.len(), bytes: head.len() + page.len() };
            file.extend(head);
            file.extend(page);
            chunk
        });
        let chunks: Vec<Chunk> = chunks.collect();
        groups.push((group.len(), chunks));
    }
    let footer = footer(rows, columns, &groups);
    file.extend(&footer);
    file.extend(length(footer.len()).to_le_bytes());
    file.extend(MAGIC);
    file
}

/// Where the values of a column in a group are, with their header.
struct Chunk {
    offset: usize,
    bytes: usize,
}

fn page_header(bytes: usize, rows: usize) -> Vec<u8> {
    let mut head = Thrift::default();
    head.structure(|head| {
        head.int32(1, word::DATA_PAGE);
        head.int32(2, length(bytes) as i32);
        head.int32(3, length(bytes) as i32);
        head.field(5, Thrift::STRUCT);
        head.structure(|page| {
            page.int32(1, length(rows) as i32);
            page.int32(2, word::PLAIN);
            page.int32(3, word::RLE);
            page.int32(4, word::RLE);
        });
    });
    head.bytes
}

fn footer(rows: usize, columns: &[ParquetColumn<'_>], groups: &[(usize, Vec<Chunk>)]) -> Vec<u8> {
    let mut footer = Thrift::default();
    footer.structure(|file| {
        file.int32(1, 1);
        file.list(2, Thrift::STRUCT, columns.len() + 1);
        file.structure(|root| {
            root.text(4, "schema");
            root.int32(5, length(columns.len()) as i32);
        });
        for column in columns {
            file.structure(|element| {
                element.int32(1, column.values.word());
                element.int32(3, word::OPTIONAL);
                element.text(4, column.name);
                if let ParquetValues::Texts(_) = column.values {
                    element.int32(6, word::UTF8);
                    element.field(10, Thrift::STRUCT);
                    element.structure(|logical| {
                        logical.field(1, Thrift::STRUCT);
                        logical.structure(|_| {});
                    });
                }
            });
        }
        file.int64(3, rows);
        file.list(4, Thrift::STRUCT, groups.len());
        for (rows, chunks) in groups {
            file.structure(|group| row_group(group, *rows, columns, chunks));
        }
        file.text(6, "post");
    });
    footer.bytes
}

fn row_group(group: &mut Thrift, rows: usize, columns: &[ParquetColumn<'_>], chunks: &[Chunk]) {
    group.list(1, Thrift::STRUCT, columns.len());
    for (column, chunk) in columns.iter().zip(chunks) {
        group.structure(|told| {
            told.int64(2, chunk.offset);
            told.field(3, Thrift::STRUCT);
            told.structure(|data| {
                data.int32(1, column.values.word());
                data.list(2, Thrift::INT32, 2);
                data.zigzag(i64::from(word::PLAIN));
                data.zigzag(i64::from(word::RLE));
                data.list(3, Thrift::BINARY, 1);
                data.binary(column.name);
                data.int32(4, word::UNCOMPRESSED);
                data.int64(5, rows);
                data.int64(6, chunk.bytes);
                data.int64(7, chunk.bytes);
                data.int64(9, chunk.offset);
            });
        });
    }
    group.int64(2, chunks.iter().map(|chunk| chunk.bytes).sum());
    group.int64(3, rows);
}

/// Thrift's compact protocol.
#[derive(Default)]
struct Thrift {
    bytes: Vec<u8>,
    /// Number of the last field of the structure that is being written.
    last: u8,
}

impl Thrift {
    const INT32: u8 = 5;
    const INT64: u8 = 6;
    const BINARY: u8 = 8;
    const LIST: u8 = 9;
    const STRUCT: u8 = 12;

    /// Seven bits a byte, the lowest first.
    fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }

    /// The sign in the lowest bit.
    fn zigzag(&mut self, value: i64) {
        self.varint((value << 1 ^ value >> 63) as u64);
    }

    /// Fields come in order, none farther than fifteen from the one before.
    fn field(&mut self, number: u8, kind: u8) {
        self.bytes.push((number - self.last) << 4 | kind);
        self.last = number;
    }

    fn structure(&mut self, fields: impl FnOnce(&mut Self)) {
        let last = std::mem::take(&mut self.last);
        fields(self);
        self.bytes.push(0);
        self.last = last;
    }

    fn int32(&mut self, number: u8, value: i32) {
        self.field(number, Self::INT32);
        self.zigzag(i64::from(value));
    }

    fn int64(&mut self, number: u8, value: usize) {
        self.field(number, Self::INT64);
        self.zigzag(value as i64);
    }

    fn binary(&mut self, text: &str) {
        self.varint(text.len() as u64);
        self.bytes.extend(text.as_bytes());
    }

    fn text(&mut self, number: u8, text: &str) {
        self.field(number, Self::BINARY);
        self.binary(text);
    }

    /// What follows are so many of a kind.
    fn list(&mut self, number: u8, kind: u8, count: usize) {
        self.field(number, Self::LIST);
        if count < 15 {
            self.bytes.push((count as u8) << 4 | kind);
        } else {
            self.bytes.push(0xF0 | kind);
            self.varint(count as u64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_its_levels_and_then_its_values() {
        let values = ParquetValues::Integers(&[Some(1), None, Some(-2)]);
        let mut wanted = vec![2, 0, 0, 0, 0b11, 0b101];
        wanted.extend(1_i64.to_le_bytes());
        wanted.extend((-2_i64).to_le_bytes());
        assert_eq!(values.page(0..3), wanted);
        let texts = [Some("é".to_owned())];
        let text = ParquetValues::Texts(&texts).page(0..1);
        assert_eq!(text, [2, 0, 0, 0, 3, 1, 2, 0, 0, 0, 0xC3, 0xA9]);
    }

    #[test]
    fn headers_are_as_the_compact_protocol_has_them() {
        let mut told = Thrift::default();
        told.structure(|told| {
            told.int32(1, -1);
            told.int64(3, 300);
            told.text(4, "ab");
            told.list(10, Thrift::INT32, 20);
        });
        let wanted = [0x15, 0x01, 0x26, 0xD8, 0x04, 0x18, 2, b'a', b'b', 0x69, 0xF5, 20, 0];
        assert_eq!(told.bytes, wanted);
    }

    #[test]
    fn a_file_is_marked_at_both_ends_and_tells_where_its_footer_is() {
        let rows: Vec<Option<f64>> = (0..GROUP + 1).map(|row| Some(row as f64)).collect();
        let column = ParquetColumn { name: "x", values: ParquetValues::Numbers(&rows) };
        let file = bytes(rows.len(), &[column]);
        assert!(file.starts_with(MAGIC) && file.ends_with(MAGIC));
        let end = file.len() - 8;
        let length = u32::from_le_bytes(file[end..end + 4].try_into().unwrap()) as usize;
        // Version 1, two elements of the schema.
        assert_eq!(file[end - length..][..4], [0x15, 2, 0x19, 0x2C]);
        assert!(bytes(0, &[]).ends_with(MAGIC));
    }
}
