//! Properties of shapes, compared with independent formulas for the same numbers.

use super::*;

fn of(shape: &str, d: &[f64]) -> Properties {
    section_properties(shape, d).expect("a section")
}

fn close(found: f64, expected: f64, what: &str) {
    assert!(
        (found / expected - 1.0).abs() < 1e-12,
        "{what}: {found} {expected}"
    );
}

#[test]
fn boxes_are_outer_less_inner_rectangles() {
    let found = of("BOX", &[6.0, 10.0, 0.5, 0.25]);
    close(found.area, 60.0 - 5.5 * 9.0, "A");
    close(found.i1, (6.0 * 1000.0 - 5.5 * 729.0) / 12.0, "I1");
    close(found.i2, (10.0 * 216.0 - 9.0 * 5.5f64.powi(3)) / 12.0, "I2");
    // Roark, rectangular tube of two wall thicknesses
    let (b, h, t1, t2) = (6.0f64, 10.0f64, 0.5f64, 0.25f64);
    let roark =
        2.0 * t1 * t2 * (b - t2).powi(2) * (h - t1).powi(2) / (b * t2 + h * t1 - t2 * t2 - t1 * t1);
    close(found.j, roark, "J");
    assert_eq!(found, of("BOX1", &[6.0, 10.0, 0.5, 0.5, 0.25, 0.25]));
}

#[test]
fn flanged_shapes_are_a_rectangle_less_its_sides() {
    let found = of("I", &[10.0, 4.0, 4.0, 0.3, 0.5, 0.5]);
    close(found.area, 40.0 - 3.7 * 9.0, "A");
    close(found.i1, (4.0 * 1000.0 - 3.7 * 729.0) / 12.0, "I1");
    close(found.i2, (2.0 * 0.5 * 64.0 + 9.0 * 0.027) / 12.0, "I2");
    close(found.j, (2.0 * 4.0 * 0.125 + 9.5 * 0.027) / 3.0, "J");
    close(found.k1 * found.area, 2.7, "k1 A");
    let other = of("I1", &[3.7, 0.3, 9.0, 10.0]);
    for (a, b) in [
        (found.area, other.area),
        (found.i1, other.i1),
        (found.i2, other.i2),
        (found.j, other.j),
    ] {
        close(a, b, "I1 is I by other dimensions");
    }
    let turned = of("H", &[9.0, 1.0, 4.0, 0.3]);
    close(turned.i1, found.i2, "H is I on its side");
    close(turned.i2, found.i1, "H is I on its side");
    close(turned.k2, found.k1, "H is I on its side");
}

#[test]
fn channels_agree_in_their_three_descriptions() {
    let found = of("CHAN", &[3.0, 8.0, 0.25, 0.5]);
    // about the centroid, by the rule A (z^2) moved from the back of the web
    let (area, first) = (
        8.0 * 0.25 + 2.0 * 2.75 * 0.5,
        8.0 * 0.25 * 0.125 + 2.75 * (0.25 + 1.375),
    );
    let second = 8.0 * 0.25f64.powi(3) / 3.0 + (3.0f64.powi(3) - 0.25f64.powi(3)) / 3.0;
    close(found.area, area, "A");
    close(found.i1, (3.0 * 512.0 - 2.75 * 343.0) / 12.0, "I1");
    close(found.i2, second - first * first / area, "I2");
    let same = of("CHAN1", &[2.75, 0.25, 7.0, 8.0]);
    let turned = of("CHAN2", &[0.5, 0.25, 3.0, 8.0]);
    for (a, b) in [
        (found.i1, same.i1),
        (found.i2, same.i2),
        (found.j, same.j),
        (found.k1, same.k1),
    ] {
        close(a, b, "CHAN1");
    }
    for (a, b) in [
        (found.i1, turned.i2),
        (found.i2, turned.i1),
        (found.j, turned.j),
        (found.k2, turned.k1),
    ] {
        close(a, b, "CHAN2");
    }
}

#[test]
fn tees_and_crosses_move_to_their_centroid() {
    let found = of("T", &[4.0, 6.0, 0.5, 0.25]);
    let (area, first) = (2.0 + 5.5 * 0.25, 2.0 * 5.75 + 5.5 * 0.25 * 2.75);
    let second = 4.0 * (216.0 - 5.5f64.powi(3)) / 3.0 + 0.25 * 5.5f64.powi(3) / 3.0;
    close(found.area, area, "A");
    close(found.i1, second - first * first / area, "I1");
    close(found.i2, (0.5 * 64.0 + 5.5 * 0.25f64.powi(3)) / 12.0, "I2");
    assert_eq!(found, of("T2", &[4.0, 6.0, 0.5, 0.25]));
    let turned = of("T1", &[4.0, 5.5, 0.5, 0.25]);
    close(turned.i2, found.i1, "T1");
    let cross = of("CROSS", &[3.0, 0.5, 5.0, 0.25]);
    close(cross.area, 2.5 + 0.75, "A");
    close(cross.i1, (0.5 * 125.0 + 3.0 * 0.25f64.powi(3)) / 12.0, "I1");
    close(
        cross.i2,
        (0.25 * 3.5f64.powi(3) + 4.75 * 0.125) / 12.0,
        "I2",
    );
}

#[test]
fn torsion_of_a_square_and_of_a_strip_have_their_known_values() {
    // Timoshenko and Goodier: 0.1406 a^4, and a b^3/3 for a thin strip
    assert!((of("BAR", &[1.0, 1.0]).j - 0.1406).abs() < 3e-4);
    assert!((of("BAR", &[1.0, 100.0]).j / (100.0 / 3.0 * (1.0 - 0.63 * 0.01)) - 1.0).abs() < 1e-8);
    assert!((of("BAR", &[2.0, 1.0]).j - 0.229 * 2.0).abs() < 1e-3);
    close(of("ROD", &[2.0]).j, 8.0 * PI, "rod");
    close(of("TUBE", &[2.0, 1.0]).i1, 15.0 / 4.0 * PI, "tube");
    assert_eq!(of("TUBE2", &[2.0, 1.0]), of("TUBE", &[2.0, 1.0]));
}

#[test]
fn dimensions_that_do_not_fit_are_refused() {
    let wrong: [(&str, &[f64]); 16] = [
        ("ROD", &[0.0]),
        ("TUBE", &[1.0, 1.0]),
        ("TUBE", &[1.0, 2.0]),
        ("TUBE", &[1.0, -0.5]),
        ("TUBE2", &[1.0, 1.5]),
        ("BAR", &[1.0, -1.0]),
        ("BOX", &[1.0, 1.0, 0.5, 0.1]),
        ("BOX", &[1.0, 1.0, 0.1, 0.5]),
        ("I", &[1.0, 1.0, 1.0, 0.1, 0.5, 0.5]),
        ("I1", &[1.0, 0.1, 2.0, 1.0]),
        ("H", &[-1.0, 2.0, 1.0, 0.1]),
        ("T", &[1.0, 0.2, 0.2, 0.1]),
        ("CHAN", &[1.0, 1.0, 1.0, 0.1]),
        ("CHAN", &[1.0, 1.0, 0.1, 0.5]),
        ("CROSS", &[1.0, 0.1, 1.0, 2.0]),
        ("BAR", &[1e200, 1e200]),
    ];
    for (shape, d) in wrong {
        assert_eq!(
            section_properties(shape, d),
            Err(ShapeError::Dimensions),
            "{shape} {d:?}"
        );
    }
    assert_eq!(
        section_properties("HEXA", &[1.0; 3]),
        Err(ShapeError::Unknown)
    );
}

#[test]
fn angles_and_zeds_have_principal_axes_between_their_plates() {
    // a square angle of thin legs: the axis of the larger second moment is at -45 degrees, as I12 is negative
    let (b, t) = (10.0f64, 1.0f64);
    let found = of("L", &[b, b, t, t]);
    close(found.area, 2.0 * b * t - t * t, "A");
    close(found.turn, -std::f64::consts::FRAC_PI_4, "angle");
    // legs y = 0 and z = 0 of length b, less their common square, moved to the centroid
    let area = found.area;
    let first = (b * b * t + (b - t) * t * t) / 2.0 / area;
    let second = (t * b.powi(3) + (b - t) * t.powi(3)) / 3.0 - area * first * first;
    let product = t * t * b * b / 4.0 + t * t * (b * b - t * t) / 4.0 - area * first * first;
    close(found.i1, second - product, "larger");
    close(found.i2, second + product, "smaller");
    // a zed is point symmetric: its product of inertia is that of its flanges
    let found = of("Z", &[4.0, 0.5, 9.0, 10.0]);
    let i1 = (0.5 * 1000.0 + 2.0 * 4.0 * 0.125) / 12.0 + 2.0 * 2.0 * 4.75f64.powi(2);
    let i2 = (10.0 * 0.125 + 2.0 * 0.5 * 64.0) / 12.0 + 2.0 * 2.0 * 2.25f64.powi(2);
    let i12 = -2.0 * 2.0 * 4.75 * 2.25;
    close(found.i1 + found.i2, i1 + i2, "sum");
    close(found.i1 * found.i2, i1 * i2 - i12 * i12, "determinant");
    close((2.0 * found.turn).tan(), 2.0 * i12 / (i1 - i2), "angle");
}

#[test]
fn hats_are_a_rectangle_less_its_hollow_with_brims() {
    let found = of("HAT", &[20.0, 2.0, 15.0, 5.0]);
    close(found.area, 15.0 * 20.0 - 11.0 * 18.0 + 2.0 * 5.0 * 2.0, "A");
    close(
        found.i2,
        (20.0 * 15.0f64.powi(3) - 18.0 * 11.0f64.powi(3)) / 12.0
            + 2.0 * (2.0 * 125.0 / 12.0 + 10.0 * 100.0),
        "I2",
    );
    let first = 15.0 * 20.0 * 10.0 - 11.0 * 18.0 * 9.0 + 20.0;
    let second = (15.0 * 8000.0 - 11.0 * 18.0f64.powi(3) + 10.0 * 8.0) / 3.0;
    close(found.i1, second - first * first / found.area, "I1");
    close(found.j, (13.0 + 36.0 + 12.0) * 8.0 / 3.0, "J");
}
