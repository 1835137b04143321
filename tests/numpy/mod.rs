//! numpy, in the environment of the other codes, loads what is written, and writes what is loaded.

use std::path::{Path, PathBuf};
use std::process::Command;

use formats::tables::{TableFormat, read, write};

#[allow(dead_code, reason = "the tests of tables use the rest")]
#[path = "../tables/sets.rs"]
mod sets;

use crate::crosscheck::environment;
use sets::{Dice, bits, bogie_grid, bytes, folder, girderway, random_factored, random_set, told};

/// The Python of the environment of the other codes, which have numpy.
fn python() -> PathBuf {
    environment().folder().join("bin").join("python")
}

fn run(python: &Path, folder: &Path, script: &str) -> String {
    let run = Command::new(python)
        .args(["-I", "-c", script])
        .current_dir(folder)
        .output()
        .expect("Python starts");
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    String::from_utf8(run.stdout).expect("text")
}

/// Lines of bits as Python prints them.
const BITS: &str = "import numpy
def bits(a):
    for v in numpy.ravel(a).astype(float).view('u8'):
        print(v)
";

fn printed(text: &str) -> Vec<u64> {
    text.lines()
        .map(|line| line.parse().expect("bits"))
        .collect()
}

#[test]
fn numpy_loads_equal_bits() {
    let python = python();
    let folder = folder();
    let mut dice = Dice::new(41);
    let set = random_set(&mut dice);
    std::fs::write(
        folder.path().join("a.npz"),
        write(&set, TableFormat::Npz).expect("writable"),
    )
    .expect("writable");
    let script = format!(
        "{BITS}
d = numpy.load('a.npz')
for k in d['tables']:
    bits(d[k + '_x']); bits(d[k + '_z']); bits(d[k])
k = d['curves'][0]
bits(d[k + '_x']); bits(d[k])"
    );
    assert_eq!(printed(&run(&python, folder.path(), &script)), bits(&set));
    let script = "import numpy
d = numpy.load('a.npz')
print(d['name'], *d['units'], *d['tables'], *d['ids'], *d['quantity'], sep='|')
print(d['bridge_rail_vertical_longitudinal'].shape, d['bridge_rail_vertical'].dtype, d['curves_phi'].shape)";
    let expected = "bridge|ft|lbf|s|bridge_rail_vertical|bridge_rail_vertical_longitudinal|spare|6|10|31|vertical|\
                    vertical_longitudinal|\n(4, 7) float64 (9, 1)\n";
    assert_eq!(run(&python, folder.path(), script), expected);
}

/// `stations`, `vertical`, `lateral`: what a user of numpy looks for; and phi phi^T of the factored form.
#[test]
fn numpy_users_are_at_home_in_a_file_of_a_girder() {
    let python = python();
    let folder = folder();
    bogie_grid(folder.path());
    let plain = girderway(folder.path(), &["splines", "grid.json", "-o", "plain.npz"]);
    assert_eq!(plain.status.code(), Some(0), "{}", told(&plain));
    let run_factored = girderway(
        folder.path(),
        &[
            "splines",
            "grid.json",
            "-o",
            "factored.npz",
            "--form",
            "factored",
        ],
    );
    assert_eq!(
        run_factored.status.code(),
        Some(0),
        "{}",
        told(&run_factored)
    );
    let script = "import numpy
d = numpy.load('plain.npz'); f = numpy.load('factored.npz')
assert list(d['stations']) == [-15, 0, 15, 30, 45, 60, 75]
assert (d['vertical'] == d['vertical'].T).all()
assert abs(d['vertical'][3, 3] - 60**3 / 48 / (9.528 * 4.32e9)) < 1e-20
for k in ['vertical', 'lateral', 'longitudinal']:
    phi = f[k + '_phi']
    assert abs(phi @ phi.T - d[k]).max() < 1e-14 * abs(d[k]).max(), k
cross = f['vertical_phi'] @ f['longitudinal_phi'].T
assert abs(cross - d['vertical_longitudinal']).max() < 1e-14 * abs(d['vertical_longitudinal']).max()";
    run(&python, folder.path(), script);
}

#[test]
fn what_numpy_saves_is_read_bit_for_bit() {
    let python = python();
    let folder = folder();
    let mut dice = Dice::new(42);
    for set in [random_set(&mut dice), random_factored(&mut dice)] {
        let path = folder.path().join("a.npz");
        std::fs::write(&path, write(&set, TableFormat::Npz).expect("writable")).expect("writable");
        let script = "import numpy
d = dict(numpy.load('a.npz'))
numpy.savez('plain.npz', **d)
numpy.savez_compressed('packed.npz', **d)
numpy.savez('turned.npz', **{k: numpy.asfortranarray(v) for k, v in d.items()})
numpy.savez('swapped.npz', **{k: v.astype(v.dtype.newbyteorder()) for k, v in d.items()})";
        run(&python, folder.path(), script);
        for name in ["plain.npz", "packed.npz", "turned.npz", "swapped.npz"] {
            let found = read(name, &bytes(&folder.path().join(name)), None);
            assert_eq!(found.as_ref(), Ok(&set), "{name}");
        }
    }
}
