//! tmp
use pomona::{Config, Picker};
use pomona_evaluate::*;
fn main() {
    let name = std::env::args().nth(1).unwrap();
    let count = std::env::args().nth(2).and_then(|s| s.parse().ok());
    let seed = std::env::args()
        .nth(3)
        .and_then(|s| s.parse().ok())
        .unwrap_or(0);
    let subjects = Subject::named(&name, count).unwrap();
    let picker = Picker::new(Config::default()).unwrap();
    let t = std::time::Instant::now();
    let e = evaluate(&subjects, &[&picker], seed, &|| {}).unwrap();
    println!("{:.1}s", t.elapsed().as_secs_f64());
    let r = &e.results[0];
    if let Some(a) = &r.angle {
        println!(
            "angle {:.2} sd {:.2} med {:.2} p95 {:.2} max {:.2} ci {:?} w10 {:.3} ge50 {:.3}",
            a.error.mean.to_degrees(),
            a.error.sd.to_degrees(),
            a.error.median.to_degrees(),
            a.error.p95.to_degrees(),
            a.error.max.to_degrees(),
            a.error.mean_interval.map(|x| x.to_degrees()),
            a.within_10_deg.share,
            a.at_least_50_deg.share
        );
    }
    println!(
        "center {:?}\nbias {:?}\nradius {:?}\nrefusals {:?}\ntiming {:?}",
        r.center_error, r.center_bias, r.radius_error, r.refusals, r.timing_ms
    );
    for l in &r.lab {
        println!(
            "{} n{} r {:.2} angle {:.2} max {:.2} paper {:.2}",
            l.orientation,
            l.answered,
            l.radius.unwrap().mean * 1e3,
            l.angle_error.as_ref().unwrap().mean.to_degrees(),
            l.angle_error.as_ref().unwrap().max.to_degrees(),
            l.paper_angle_error.to_degrees()
        );
    }
    if let Some(r) = &r.repeatability {
        println!("{r:?}");
    }
    for g in &r.groupings {
        for x in &g.groups {
            println!(
                "{:?} {:.3}.. n{} ans {:.2} angle {:?}",
                g.by,
                x.from,
                x.apples,
                x.answered.share,
                x.angle.as_ref().map(|a| a.error.mean.to_degrees())
            );
        }
    }
}
