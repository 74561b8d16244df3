//! The phases of a rig's scans, in order.

use limn::operator::{Operator, Order};
use wire::Phase;

#[test]
fn a_scan_begins_once_and_keeps_its_epoch_until_it_ends() {
    let mut operator = Operator::default();
    let shape = operator.obey(Order::Shape, 100).unwrap();
    assert_eq!((shape.header.scan, shape.header.phase, shape.header.stamp_nanos), (1, Phase::Shape, 100));
    let colour = operator.obey(Order::Colour, 200).unwrap();
    assert_eq!((colour.header.scan, colour.header.stamp_nanos), (1, 100), "the same scan, on the same clock");
    assert_eq!(operator.obey(Order::Colour, 300), None, "said twice");
    assert_eq!(operator.obey(Order::End, 400).unwrap().header.phase, Phase::End);
    assert_eq!(operator.obey(Order::End, 500), None, "nothing is left to end");
    let next = operator.obey(Order::Both, 600).unwrap();
    assert_eq!((next.header.scan, next.header.stamp_nanos), (2, 600));
}

#[test]
fn what_is_discarded_belongs_to_the_old_number() {
    let mut operator = Operator::default();
    operator.obey(Order::Both, 1).unwrap();
    let discard = operator.obey(Order::Discard, 2).unwrap();
    assert!(discard.discard);
    assert_eq!((discard.header.scan, discard.header.phase), (2, Phase::Aim));
    let again = operator.obey(Order::Both, 3).unwrap();
    assert_eq!((again.header.scan, again.discard), (2, false));
}

#[test]
fn orders_travel() {
    for order in [Order::Shape, Order::Colour, Order::Both, Order::End, Order::Discard] {
        assert_eq!(Order::from_wire(&order.to_wire()), order);
    }
}
