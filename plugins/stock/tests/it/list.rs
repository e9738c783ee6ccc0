use post_stock::{plugin, plugins};

#[test]
fn the_list_is_in_order_and_each_is_found_by_its_name() {
    assert!(plugins().is_sorted_by_key(|plugin| plugin.name()));
    assert!(plugin("fanuc").is_some_and(|fanuc| fanuc.name() == "fanuc"));
    assert!(plugin("fanuk").is_none());
}
