//! Trees are posed and leaves turned the same on the GPU and on the CPU. Needs a Vulkan driver. Mesa's software one will do.

#[path = "../tools/validate/leaves/mod.rs"]
mod leaves;
#[path = "../tools/validate/parity.rs"]
mod parity;
#[path = "../tools/validate/report.rs"]
#[allow(dead_code, reason = "this topic uses a part of it")]
mod report;
mod support;

#[test]
fn posed_vertices_agree_on_gpu_and_cpu() {
    check(&parity::run());
}

#[test]
fn leaves_turn_the_same_and_without_a_jump() {
    check(&leaves::run());
}

fn check(report: &report::Report) {
    report.print();
    println!("{:#}", report.to_json());
    assert!(report.holds());
}
