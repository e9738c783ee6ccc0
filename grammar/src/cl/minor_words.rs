//! Minor words: what stands behind a major word, by records that have them.

use super::MajorWord;

/// Records of words that are followed by others, each minor word in one of them; in the order of their words.
static RECORDS: &[&str] = &[
    "COOLNT/ON",
    "COOLNT/OFF",
    "COOLNT/FLOOD",
    "COOLNT/MIST",
    "COOLNT/THRU",
    "COOLNT/AIR",
    "CUTCOM/LEFT",
    "CUTCOM/RIGHT,XYPLAN",
    "CUTCOM/LEFT,YZPLAN",
    "CUTCOM/LEFT,ZXPLAN,OSETNO,3",
    "CUTCOM/ON",
    "CUTCOM/OFF",
    "CYCLE/DRILL,FEDTO,-10,MMPM,200,RAPTO,3",
    "CYCLE/DEEP,FEDTO,-10,STEP,3,MMPM,200,RAPTO,3",
    "CYCLE/BRKCHP,FEDTO,-10,STEP,3,IPM,8,RAPTO,3",
    "CYCLE/TAP,FEDTO,-10,PITCH,1.5,RAPTO,3",
    "CYCLE/BORE,FEDTO,-10,MMPR,0.1,RAPTO,3,DWELL,1",
    "CYCLE/REAM,FEDTO,-10,IPR,0.005,RAPTO,3,RTRCTO,20",
    "CYCLE/FACE,FEDTO,-1,MMPM,100,RAPTO,3",
    "CYCLE/CSINK,DIAMET,8,ANGLE,90,MMPM,100,RAPTO,3",
    "CYCLE/ON",
    "CYCLE/OFF",
    "DELAY/3,REV",
    "FEDRAT/MMPM,250",
    "FEDRAT/IPM,10",
    "FEDRAT/PERMIN,250",
    "FEDRAT/MMPR,0.1",
    "FEDRAT/IPR,0.004",
    "FEDRAT/PERREV,0.1",
    "FEDRAT/INVERS,2",
    "FEDRAT/RAPID",
    "LOADTL/3,LENGTH,120,OSETNO,3",
    "LOADTL/3,ADJUST,3",
    "MODE/MILL",
    "MODE/TURN",
    "MOVARC/0,0,0,0,0,1,10,ANGLE,90",
    "MULTAX/ON",
    "MULTAX/OFF",
    "ROTABL/AAXIS,90,CLW",
    "ROTABL/BAXIS,90,CCLW",
    "ROTABL/CAXIS,90,INCR",
    "ROTABL/ABSOL,CAXIS,90",
    "SELECT/TOOL,4",
    "SET/OFSETL,2",
    "SPINDL/RPM,9000,CLW",
    "SPINDL/SMM,200,MAXRPM,3000,CCLW",
    "SPINDL/SFM,600,CLW",
    "SPINDL/ON",
    "SPINDL/OFF",
    "SPINDL/ORIENT",
    "TLDATA/MILL,10,1,75,0,0",
    "UNITS/MM",
    "UNITS/INCH",
    "UNITS/CM",
    "UNITS/M",
    "UNITS/FEET",
];

/// The words behind the major one of a record.
fn behind(record: &str) -> impl Iterator<Item = &str> {
    let items = record.split_once('/').map_or("", |(_, items)| items).split(',');
    items.map(str::trim).filter(|item| item.starts_with(|first: char| first.is_ascii_alphabetic()))
}

impl MajorWord {
    /// A record of each form that is known of it.
    pub fn records(&self) -> impl Iterator<Item = &'static str> {
        let own = Some(self.example).filter(|example| !example.is_empty());
        let is_own = move |record: &&&str| {
            record.split_once('/').is_some_and(|(word, _)| word == self.name())
        };
        own.into_iter().chain(RECORDS.iter().filter(is_own).copied())
    }

    /// The minor words that may stand behind it, each once.
    pub fn minor_words(&self) -> Vec<&'static str> {
        let mut words: Vec<&str> = Vec::new();
        // Of a free text no item is a word.
        if !matches!(self.behind, super::vocabulary::ArgumentForm::Items(_)) {
            return words;
        }
        for word in self.records().flat_map(behind) {
            if !words.contains(&word) {
                words.push(word);
            }
        }
        words
    }
}
