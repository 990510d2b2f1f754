//! Trees are posed the same on the GPU and on the CPU. Needs a Vulkan driver. Mesa's software one will do.

#[path = "../tools/validate/parity.rs"]
mod parity;
#[path = "../tools/validate/report.rs"]
#[allow(dead_code, reason = "this topic uses a part of it")]
mod report;
mod support;

#[test]
fn posed_vertices_agree_on_gpu_and_cpu() {
    let report = parity::run();
    report.print();
    println!("{:#}", report.to_json());
    assert!(report.holds());
}
