//! References of other make: a classical Runge-Kutta method, rails by formula.

use nalgebra::DMatrix;
use sim::{Dynamics, Foundation, Shapes, Structure};
use splines::{Axis, Compliance, Error, Influence, Probe};

/// y at `end` from y(0) = `y`, by `steps` steps of the classical Runge-Kutta method.
pub fn rk4<const N: usize>(
    mut y: [f64; N],
    end: f64,
    steps: u32,
    mut rate: impl FnMut(f64, [f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = end / f64::from(steps);
    for i in 0..steps {
        let t = h * f64::from(i);
        let add = |k: [f64; N], by: f64| std::array::from_fn(|j| y[j] + by * k[j]);
        let k1 = rate(t, y);
        let k2 = rate(t + 0.5 * h, add(k1, 0.5 * h));
        let k3 = rate(t + 0.5 * h, add(k2, 0.5 * h));
        let k4 = rate(t + h, add(k3, h));
        for j in 0..N {
            y[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
        }
    }
    y
}

/// A rail without end whose G(p, q) and dG/dx_p are given by a formula.
pub struct Kernel<F>(pub F);

impl<F: Fn(Probe, Probe) -> [f64; 2] + Send + Sync> Compliance for Kernel<F> {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                [out.value[(i, j)], out.slope[(i, j)]] = (self.0)(*p, *q);
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        None
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// One freedom that moves every place of the rail alike, by these amounts along x, y and z.
struct Sled([f64; 3]);

impl Shapes for Sled {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        let [x, y, z] = self.0;
        value[0] = match at.axis {
            Axis::Longitudinal => x,
            Axis::Vertical => y,
            Axis::Lateral => z,
        };
        slope[0] = 0.0;
        Ok(())
    }
}

/// A rail on one freedom of mass `m`, stiffness `k` and damping `c`, which moves it by `along` (x, y, z).
pub fn sled(m: f64, k: f64, c: f64, along: [f64; 3]) -> Foundation {
    let one = |value: f64| DMatrix::from_element(1, 1, value);
    let dynamics = Dynamics::Matrices {
        mass: one(m),
        damping: one(c),
        stiffness: one(k),
    };
    Foundation {
        structure: Some(Structure {
            dynamics,
            shapes: Box::new(Sled(along)),
        }),
        is_loaded_along: true,
        ..Foundation::default()
    }
}
