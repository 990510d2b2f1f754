//! The graphics processor poses trees as the processor does. Needs a Vulkan driver; Mesa's software one will do.

#[path = "../examples/validate/parity.rs"]
mod parity;
#[path = "../examples/validate/report.rs"]
#[allow(dead_code, reason = "this topic uses a part of it")]
mod report;
mod support;

#[test]
fn posed_vertices_agree_on_both_processors() {
    let report = parity::run();
    report.print();
    println!("{:#}", report.to_json());
    assert!(report.holds());
}
