use pxpl5::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let e =
        Experiment::new(MachineConfig::small_hmd(), Jitp::new(Viewpoint::Field, true), scene::builtin(&a[1]).unwrap());
    let o = e.fields(a[2].parse().unwrap()).pixels(Pixels::Off).run().unwrap();
    println!("{} events, {} s", o.machine().events(), o.host_seconds());
}
