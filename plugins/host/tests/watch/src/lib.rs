//! A dialect that declares everything and refuses an event that comes where the guide says it does not.

use post_kit::EventOrder;
use post_plugin::{
    CAPABILITIES, Capabilities, Dialect, Event, Format, PlaneAngles, Setup, export_dialect,
};

struct Watch {
    words: usize,
    order: EventOrder,
}

impl Dialect for Watch {
    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        Ok(Watch { words: setup.words.len(), order: EventOrder::default() })
    }

    fn format(&self) -> Format {
        Format {
            words: vec![4; self.words],
            feed: 1,
            inverse_time: Some(3),
            feed_per_revolution: 4,
            extension: "txt".to_owned(),
            plane_angles: PlaneAngles::Zxz,
            plane_decimals: 4,
            ..Format::default()
        }
    }

    fn capabilities(&self) -> Capabilities {
        // It retracts and parks wherever it is sent.
        let all = CAPABILITIES.iter().map(|spec| spec.set);
        let not = [
            Capabilities::RETRACT_SAID,
            Capabilities::CYCLE_NO_DWELL,
            Capabilities::NO_PARK,
            Capabilities::RAPIDS_AT_FEED,
        ];
        let all = all.filter(|set| !not.contains(set));
        all.fold(Capabilities::NONE, |all, set| all | set)
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        self.order.next(event)?;
        out.push_str(event.name());
        out.push('\n');
        Ok(())
    }
}

export_dialect!(watch, Watch);
