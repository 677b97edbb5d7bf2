//! The search for planes against brute force.

use proptest::prelude::*;

use super::*;

/// Candidates at even ratios between 1 and `far`, maps as wide as the far ends of their slices
/// and a picture that is filled evenly: the papers' own setting. `power` is that of depth in
/// the density of weights; theirs is −2.
fn even(len: usize, far: f64, texels: &[f64], power: i32) -> (Vec<f64>, Costs) {
    let depths: Vec<f64> = (0..len).map(|i| far.powf(i as f64 / (len - 1) as f64)).collect();
    let integral = |depth: f64| depth.powi(power + 1) / f64::from(power + 1);
    let mut edges = vec![0.0; len * len];
    let mut begins = vec![(0, 0.0); len * len];
    for i in 0..len {
        for j in i + 1..len {
            edges[i * len + j] = depths[j];
            begins[i * len + j] = (j, 0.0);
        }
    }
    let weights_before = depths.iter().map(|&depth| integral(depth) - integral(1.0)).collect();
    (depths, Costs { len, edges, begins, weights_before, texels: texels.to_vec(), last_edge: None })
}

fn cheapest(costs: &Costs) -> Vec<usize> {
    let (mut search, mut planes) = (Search::default(), Vec::new());
    search.cheapest(costs, &mut planes);
    planes
}

#[test]
fn an_even_scene_gets_the_logarithmic_planes_and_another_cost_gets_others() {
    for m in 1..=6 {
        let (_, costs) = even(61, 1000.0, &vec![512.0; m], -2);
        let planes = cheapest(&costs);
        assert_eq!(planes, (0..=m).map(|i| i * 60 / m).collect::<Vec<_>>());
        let closed_form = m as f64 * (1000f64.powf(1.0 / m as f64) - 1.0) / 512.0;
        assert!((costs.total(&planes) - closed_form).abs() < 1e-12 * closed_form);
    }
    let (_, wrong) = even(61, 1000.0, &[512.0; 3], -3);
    assert_ne!(cheapest(&wrong), [0, 20, 40, 60]);
}

#[test]
fn a_larger_map_takes_a_longer_slice() {
    let first = |texels: &[f64]| cheapest(&even(61, 1000.0, texels, -2).1)[1];
    let same = first(&[512.0, 512.0]);
    assert!(first(&[2048.0, 512.0]) > same + 5);
    assert!(first(&[512.0, 2048.0]) < same - 5);
}

#[test]
fn a_slice_without_weight_costs_nothing() {
    // All that casts shadows stands between candidates 7 and 9 and 20 and 22: planes in the
    // gap leave two small maps.
    let len = 30;
    let occupied = |i: usize| (7..9).contains(&i) || (20..22).contains(&i);
    let (mut edges, mut begins, mut weights_before) = (vec![0.0; len * len], vec![(0, 0.0); len * len], vec![0.0]);
    for i in 0..len {
        for j in i + 1..len {
            let held: Vec<usize> = (i..j).filter(|&k| occupied(k)).collect();
            edges[i * len + j] = held.first().map_or(0.0, |first| (held[held.len() - 1] + 1 - first) as f64);
            begins[i * len + j] = (j, 0.0);
        }
        weights_before.push(weights_before[i] + f64::from(u8::from(occupied(i))));
    }
    let costs = Costs { len, edges, begins, weights_before, texels: vec![1.0; 2], last_edge: None };
    let planes = cheapest(&costs);
    assert!((9..=20).contains(&planes[1]), "{planes:?}");
    assert_eq!(costs.total(&planes), 8.0);
}

/// Random costs with bands that reach back.
fn any_costs() -> impl Strategy<Value = Costs> {
    (3usize..9, 1usize..5).prop_filter("room for the splits", |(len, m)| len > m).prop_flat_map(|(len, m)| {
        let edge = prop_oneof![Just(0.0), 0.0..100.0];
        let weight = prop_oneof![2 => Just(0.0), 3 => 0.0..1.0];
        let edges = proptest::collection::vec(edge, len * len);
        let back = proptest::collection::vec((0usize..3, prop_oneof![Just(0.0), 0.0..1.0]), len * len);
        let weights = proptest::collection::vec(weight, len - 1);
        let texels = proptest::collection::vec(1.0..2000.0, m);
        (edges, back, weights, texels).prop_map(move |(edges, back, weights, texels)| {
            let mut begins = vec![(0, 0.0); len * len];
            for i in 0..len {
                for j in i + 1..len {
                    let (back, share) = back[i * len + j];
                    let begin = j.saturating_sub(back);
                    begins[i * len + j] = (begin, if begin < j { share } else { 0.0 });
                }
            }
            let sum = |sum: &mut f64, weight: &f64| {
                *sum += weight;
                Some(*sum)
            };
            let weights_before = std::iter::once(0.0).chain(weights.iter().scan(0.0, sum)).collect();
            Costs { len, edges, begins, weights_before, texels, last_edge: None }
        })
    })
}

/// All sets of planes.
fn all_rows(len: usize, m: usize) -> Vec<Vec<usize>> {
    let mut rows = vec![vec![0]];
    for split in 1..=m {
        let next = |row: Vec<usize>| {
            let from = row[split - 1] + 1;
            let to = if split == m { len - 1 } else { len - 2 };
            (from.max(if split == m { len - 1 } else { from })..=to).map(move |i| [&row[..], &[i]].concat())
        };
        rows = rows.into_iter().flat_map(next).collect();
    }
    rows
}

proptest! {
    #[test]
    fn the_search_finds_what_trying_all_finds(costs in any_costs()) {
        let m = costs.texels.len();
        let planes = cheapest(&costs);
        prop_assert_eq!(planes.len(), m + 1);
        prop_assert!(planes[0] == 0 && planes[m] == costs.len - 1 && planes.windows(2).all(|p| p[0] < p[1]));
        let least = all_rows(costs.len, m).iter().map(|row| costs.total(row)).fold(f64::INFINITY, f64::min);
        prop_assert!((costs.total(&planes) - least).abs() <= 1e-12 * least.max(1e-300), "{} {least}", costs.total(&planes));
    }
}

#[test]
fn a_last_map_that_shows_everything_gets_the_slice_of_least_weight() {
    let (depths, costs) = even(33, 100.0, &[64.0; 2], -2);
    let free = cheapest(&costs);
    // Whatever its slice, it is three times as wide as the whole range: the first map takes more.
    let whole = 3.0 * costs.edges[costs.len - 1];
    let bound = cheapest(&Costs { last_edge: Some(whole), ..costs });
    assert!(depths[bound[1]] > depths[free[1]], "{} {}", depths[bound[1]], depths[free[1]]);
}
