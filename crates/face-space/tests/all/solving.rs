use face_space::{SolveError, Solver, least_squares};
use proptest::prelude::*;

/// Numbers from -0.5 to 0.5, the same as in the program below.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32 - 0.5
    }

    fn field(&mut self, vertices: usize, scale: f32) -> Vec<[f32; 3]> {
        (0..vertices).map(|_| [0; 3].map(|_| scale * self.next())).collect()
    }
}

type Case = (u64, usize, usize, &'static [f64]);

/// Seed, vertices, fields, and what scipy 1.17.1 found for fields of these numbers and a wanted displacement
/// of four times the next ones: `scipy.optimize.lsq_linear(A, b, (-0.25, 1), method="bvls", tol=1e-14).x`.
const SCIPY: [Case; 5] = [
    (1, 5, 3, &[-0.1107959, -0.25, 0.158744]),
    (2, 12, 6, &[-0.25, 0.2414838, 1.0, -0.25, 0.3195201, 1.0]),
    (
        3,
        30,
        10,
        &[0.219962, 0.3103164, -0.25, 0.0126519, -0.25, 0.2208199, -0.091516, -0.0495609, -0.25, 0.3941265],
    ),
    (4, 9, 9, &[-0.25, -0.1094723, -0.25, 0.1176968, 1.0, 0.5362122, 0.7723234, 1.0, 0.9866431]),
    (
        5,
        40,
        20,
        &[
            0.2654542, 0.2374697, -0.0247754, 0.0666862, -0.0814017, 0.628382, -0.25, 0.1206978, 0.3747664,
            0.0144251, 0.9406824, -0.25, -0.057854, -0.2129964, 0.6728199, -0.25, 0.3716036, -0.25, -0.25,
            -0.0396935,
        ],
    ),
];

#[test]
fn values_are_those_of_scipy() {
    for (seed, vertices, count, expected) in SCIPY {
        let mut numbers = Numbers(seed);
        let fields: Vec<_> = (0..count).map(|_| numbers.field(vertices, 1.0)).collect();
        let wanted = numbers.field(vertices, 4.0);
        let fields: Vec<&[[f32; 3]]> = fields.iter().map(Vec::as_slice).collect();
        let mut values = vec![0.0; count];
        Solver::new(&fields, &vec![[-0.25, 1.0]; count]).unwrap().solve(&wanted, &mut values).unwrap();
        for (value, expected) in values.iter().zip(expected) {
            assert!((f64::from(*value) - expected).abs() < 1e-6, "{seed}: {values:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The conditions of Karush, Kuhn and Tucker, which hold at the least sum of squares and nowhere else: no
    /// slope at values within their range, none at an end that would lead back inside. Some fields are sums
    /// of others, or 0, so that there are many answers.
    #[test]
    fn no_way_from_the_answer_leads_down(seed in any::<u64>(), count in 1usize..24, vertices in 1usize..12) {
        let mut numbers = Numbers(seed);
        let mut fields: Vec<_> = (0..count).map(|_| numbers.field(vertices, 1.0)).collect();
        if count > 3 {
            fields[0] = vec![[0.0; 3]; vertices];
            fields[1] = fields[2].iter().zip(&fields[3]).map(|(a, b)| [0, 1, 2].map(|i| a[i] + b[i])).collect();
        }
        let wanted = numbers.field(vertices, 6.0);
        let ranges: Vec<[f32; 2]> = (0..count).map(|_| [numbers.next() - 0.5, numbers.next() + 0.5]).collect();
        let slices: Vec<&[[f32; 3]]> = fields.iter().map(Vec::as_slice).collect();
        let mut values = vec![0.0; count];
        Solver::new(&slices, &ranges).unwrap().solve(&wanted, &mut values).unwrap();
        let residual: Vec<f64> = (0..vertices * 3).map(|at| {
            let sum = |field: &Vec<[f32; 3]>, value: &f32| f64::from(field[at / 3][at % 3]) * f64::from(*value);
            fields.iter().zip(&values).map(|(field, value)| sum(field, value)).sum::<f64>()
                - f64::from(wanted[at / 3][at % 3])
        }).collect();
        for (index, field) in fields.iter().enumerate() {
            let slope: f64 = field.iter().flatten().zip(&residual).map(|(a, b)| f64::from(*a) * b).sum();
            let [least, most] = ranges[index];
            prop_assert!((least..=most).contains(&values[index]));
            // Values are rounded to f32.
            let small = 1e-5 * (vertices * count) as f64;
            prop_assert!(values[index] == least || slope < small, "{index}: {slope} at {}", values[index]);
            prop_assert!(values[index] == most || slope > -small, "{index}: {slope} at {}", values[index]);
        }
    }
}

#[test]
fn what_the_fields_can_show_is_found_again() {
    let mut numbers = Numbers(9);
    let fields: Vec<_> = (0..12).map(|_| numbers.field(50, 1.0)).collect();
    let slices: Vec<&[[f32; 3]]> = fields.iter().map(Vec::as_slice).collect();
    let given: Vec<f32> = (0..12).map(|at| at as f32 / 11.0).collect();
    let wanted: Vec<[f32; 3]> = (0..50)
        .map(|v| {
            [0, 1, 2].map(|i| fields.iter().zip(&given).map(|(field, weight)| field[v][i] * weight).sum())
        })
        .collect();
    let mut found = [0.0; 12];
    Solver::new(&slices, &[[0.0, 1.0]; 12]).unwrap().solve(&wanted, &mut found).unwrap();
    assert!(found.iter().zip(&given).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?}");
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let (two, three) = ([[0.0; 3]; 2], [[0.0; 3]; 3]);
    let length = |what, expected, found| Err(SolveError::Length { what, expected, found });
    let new =
        |fields: &'static [&'static [[f32; 3]]], ranges: &[[f32; 2]]| Solver::new(fields, ranges).map(|_| ());
    assert_eq!(new(&[], &[]), Ok(()));
    assert_eq!(new(&[], &[[0.0, 1.0]]), length("ranges", 0, 1));
    let fields: [&[[f32; 3]]; 2] = [&two, &three];
    assert_eq!(Solver::new(&fields, &[[0.0, 1.0]; 2]).map(|_| ()), length("vertices of a field", 2, 3));
    let fields: [&[[f32; 3]]; 1] = [&two];
    for wrong in [[1.0, 0.0], [f32::NAN, 1.0], [0.0, f32::INFINITY]] {
        assert_eq!(Solver::new(&fields, &[wrong]).map(|_| ()), Err(SolveError::Range(0)));
    }
    let mut solver = Solver::new(&fields, &[[0.0, 1.0]]).unwrap();
    assert_eq!(solver.solve(&three, &mut [0.0]), length("wanted displacements", 2, 3));
    assert_eq!(solver.solve(&two, &mut []), length("values", 1, 0));
    let mut value = [7.0];
    solver.solve(&[[f32::NAN; 3]; 2], &mut value).unwrap();
    assert_eq!(value, [0.0]);
    assert_eq!(least_squares(&[1.0], &[3.0], &[[0.0, 2.0]]), Ok(vec![2.0]));
    assert_eq!(least_squares(&[1.0], &[], &[]).map(|_| ()), length("entries of the matrix", 0, 1));
}
