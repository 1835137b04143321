use fea::*;
use splines::{Axis, Probe};
use std::time::Instant;
fn chain(cuts: &[f64]) -> (Model, Rail) {
    let points = cuts.iter().map(|&x| [x, 0.0, 0.0]).collect();
    let section = Section { e: 4.32e9, iz: 9.528, ..Section::default() };
    let members: Vec<Member> = (1..cuts.len())
        .map(|k| Member {
            points: [k - 1, k],
            kind: Kind::Beam,
            section: 0,
            orientation: [0.0, 1.0, 0.0],
            offsets: [[0.0; 3]; 2],
            releases: [[false; 6]; 2],
        })
        .collect();
    let supports = [0, cuts.len() - 1]
        .map(|point| Support { point, fix: [point == 0, true, true, true, false, false] })
        .to_vec();
    let segments = (0..members.len()).map(|member| Segment { member, offset: [0.0; 3] }).collect();
    let rail = Rail { axis: [1.0, 0.0, 0.0], segments, ..Rail::default() };
    (
        Model { points, sections: vec![section], members, supports, up: [0.0, 1.0, 0.0], ..Model::default() },
        rail,
    )
}
fn go(name: &str, cuts: &[f64], acc: f64) {
    let (m, r) = chain(cuts);
    let rails = [r];
    let t = Instant::now();
    match Frame::accurate(&m, &rails, acc) {
        Ok(f) => {
            let t1 = t.elapsed();
            let xs: Vec<f64> = (1..60).map(|k| k as f64).collect();
            let at: Vec<Probe> = xs.iter().map(|&x| Probe { rail: 0, x, axis: Axis::Vertical }).collect();
            let g = f.grid(&at).unwrap();
            let mut worst = 0.0_f64;
            let ei = 4.32e9 * 9.528;
            let l = 60.0;
            for (i, &a) in xs.iter().enumerate() {
                for (j, &b) in xs.iter().enumerate() {
                    let (p, q) = if a <= b { (a, b) } else { (b, a) };
                    let e = p * (l - q) * (l * l - p * p - (l - q) * (l - q)) / (6.0 * l * ei);
                    let s = |x: f64| x * x * (l - x) * (l - x) / (3.0 * l * ei);
                    worst = worst.max((g.value[(i, j)] - e).abs() / (s(a) * s(b)).sqrt());
                }
            }
            println!(
                "{name}: bound {:.2e} true {:.2e} cond {:.1e} frame {:?} grid {:?} n {}",
                g.certificate.error_bound,
                worst,
                f.certificate().condition,
                t1,
                t.elapsed() - t1,
                f.unknowns()
            );
        }
        Err(e) => println!("{name}: {e}"),
    }
}
fn main() {
    for acc in [1e-9, 1e-15] {
        for _ in 0..2 {
            for n in [1, 2, 3, 8, 64, 256, 2048, 8192, 32768] {
                let cuts: Vec<f64> = (0..=n).map(|k| 60.0 * f64::from(k) / f64::from(n)).collect();
                go(&format!("even {n}"), &cuts, acc);
            }
            for p in 3..13 {
                go(&format!("short 1e-{p}"), &[0.0, 20.0, 20.0 + 60.0 * 10f64.powi(-p), 60.0], acc);
            }
        }
    }
}
