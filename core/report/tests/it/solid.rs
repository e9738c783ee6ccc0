use std::f64::consts::PI;
use std::io::Cursor;

use post_report::solid::{DrawnSolid, Vertex};

/// A binary file whose header begins as a text does.
fn binary(triangles: &[[Vertex; 3]]) -> Vec<u8> {
    let mut file = [b' '; 80].to_vec();
    file[..12].copy_from_slice(b"solid column");
    file.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
    for triangle in triangles {
        file.extend([0; 12]);
        for value in triangle.iter().flatten() {
            file.extend((*value as f32).to_le_bytes());
        }
        file.extend([0; 2]);
    }
    file
}

fn text(triangles: &[[Vertex; 3]]) -> Vec<u8> {
    let mut file = String::from("SOLID Tisch \r\n");
    for triangle in triangles {
        file.push_str("  facet normal 0 0 0\r\n    outer loop\r\n");
        for [x, y, z] in triangle {
            file.push_str(&format!("      vertex {x:e} {y} {z}\r\n"));
        }
        file.push_str("    endloop\r\n  endfacet\r\n\r\n");
    }
    file.push_str("endsolid");
    file.into_bytes()
}

fn read(file: &[u8], most: usize) -> DrawnSolid {
    DrawnSolid::read(&mut Cursor::new(file), most).unwrap()
}

fn refused(file: &[u8]) -> String {
    DrawnSolid::read(&mut Cursor::new(file), 100).unwrap_err().to_string()
}

/// A box from the origin, 12 triangles.
fn cuboid(x: f64, y: f64, z: f64) -> Vec<[Vertex; 3]> {
    let corner = |bits: usize| {
        let side = |bit: usize, length: f64| if bits & bit == 0 { 0.0 } else { length };
        [side(1, x), side(2, y), side(4, z)]
    };
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .map(|corners| corners.map(corner))
        .collect()
}

/// A ball about a point: a cube of 12 n² triangles, blown up.
fn ball(middle: Vertex, radius: f64, n: usize) -> Vec<[Vertex; 3]> {
    let side = |at: usize| 2.0 * at as f64 / n as f64 - 1.0;
    let point = |face: usize, i: usize, j: usize| {
        let up = if face < 3 { 1.0 } else { -1.0 };
        let mut place = [side(i) * up, side(j), up];
        let far = place.iter().map(|value| value * value).sum::<f64>().sqrt();
        place.rotate_left(face % 3);
        std::array::from_fn(|at| middle[at] + radius * place[at] / far)
    };
    let faces = (0..6).flat_map(|face| (0..n).map(move |i| (face, i)));
    let cells = faces.flat_map(|(face, i)| (0..n).map(move |j| (face, i, j)));
    cells
        .flat_map(|(face, i, j)| {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| point(face, i, j));
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

#[test]
fn both_forms_are_read_as_they_are() {
    let wanted = cuboid(30.0, 20.5, 10.25);
    for file in [binary(&wanted), text(&wanted)] {
        let solid = read(&file, 12);
        assert_eq!(solid.triangles, wanted);
        // The diagonals of its sides are none.
        assert_eq!(solid.edges.len(), 12);
        let longest = solid.edges[0];
        assert_eq!((longest[0][0] - longest[1][0]).abs(), 30.0);
    }
}

#[test]
fn many_triangles_become_few_of_the_same_shape() {
    let (middle, radius) = ([500.0, -200.0, 30.0], 250.0);
    let file = binary(&ball(middle, radius, 120));
    for most in [4500, 800, 100] {
        let solid = read(&file, most);
        let count = solid.triangles.len();
        assert!(count <= most && count > most / 4, "{count} of {most}");
        // As far from the ball as the triangles are large, and all around it.
        let size = radius * (4.0 * PI * 2.0 / count as f64).sqrt();
        let (mut low, mut high) = (middle, middle);
        for corner in solid.triangles.iter().flatten() {
            let from: Vertex = std::array::from_fn(|at| corner[at] - middle[at]);
            let far = from.iter().map(|value| value * value).sum::<f64>().sqrt();
            assert!((far - radius).abs() < size, "{far}");
            for at in 0..3 {
                low[at] = low[at].min(corner[at]);
                high[at] = high[at].max(corner[at]);
            }
        }
        for at in 0..3 {
            assert!(high[at] - low[at] > 2.0 * (radius - size), "{low:?} {high:?}");
        }
    }
    assert_eq!(read(&file, 800), read(&file, 800));
}

#[test]
fn corners_of_a_body_stay() {
    // A box whose sides are many triangles.
    let side = |at: usize| 1000.0 * at as f64 / 60.0;
    let mut triangles = Vec::new();
    for (turn, up) in (0..3).flat_map(|turn| [(turn, 0), (turn, 60)]) {
        for (i, j) in (0..60).flat_map(|i| (0..60).map(move |j| (i, j))) {
            let point = |i: usize, j: usize| {
                let mut place = [side(i), side(j), side(up)];
                place.rotate_left(turn);
                place
            };
            triangles.push([point(i, j), point(i + 1, j), point(i + 1, j + 1)]);
            triangles.push([point(i, j), point(i + 1, j + 1), point(i, j + 1)]);
        }
    }
    let solid = read(&binary(&triangles), 800);
    assert!(solid.triangles.len() <= 800);
    for corner in 0..8 {
        let wanted: Vertex =
            std::array::from_fn(|at| if corner >> at & 1 == 1 { 1000.0 } else { 0.0 });
        assert!(solid.triangles.iter().flatten().any(|place| *place == wanted), "{wanted:?}");
    }
    // What is no surface stays something.
    let cloud: Vec<[Vertex; 3]> = (0..5000)
        .map(|at| {
            let place = |more: usize| {
                let mixed = (at * 7919 + more * 104_729) % 1_000_003;
                [(mixed % 101) as f64, (mixed / 101 % 97) as f64, (mixed / 9797 % 89) as f64]
            };
            [place(0), place(1), place(2)]
        })
        .collect();
    let count = read(&binary(&cloud), 100).triangles.len();
    assert!((1..=100).contains(&count), "{count}");
}

#[test]
fn names_are_of_any_letters() {
    let good = text(&cuboid(30.0, 20.0, 10.0));
    let name = [&b"solid Tr\xe4ger "[..], &[b'x'; 9000], b"\n"].concat();
    let rest = good.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    let file = [&name, &good[rest..], b" Tr\xe4ger\r\n\0\x1a"].concat();
    assert_eq!(read(&file, 12).triangles.len(), 12);
}

#[test]
fn what_is_no_shape_is_refused_by_its_line() {
    let good = text(&cuboid(1.0, 1.0, 1.0));
    let lines: Vec<&str> = str::from_utf8(&good).unwrap().lines().collect();
    let with = |at: usize, line: &str| {
        let mut lines = lines.clone();
        lines[at] = line;
        lines.join("\n").into_bytes()
    };
    for (file, wanted) in [
        (Vec::new(), "is no STL file"),
        (b"PK\x03\x04 something else".to_vec(), "is no STL file: it has 19 bytes"),
        (b"solid nothing\nendsolid\n".to_vec(), "no triangle"),
        (binary(&[[[1.0, 2.0, 3.0]; 3]; 200]), "no triangle with an area"),
        (binary(&cuboid(1e-3, 1e-3, 1e-3)), "no triangle with an area"),
        (good[..good.len() - 8].to_vec(), "ends before `endsolid`"),
        (lines[..5].join("\n").into_bytes(), "ends before `endsolid`"),
        (with(3, "vertex 0 zero 0"), "line 4: `vertex` and three numbers"),
        (with(3, "vertex 0 0"), "line 4: "),
        (with(3, ""), "line 7: a facet has three corners"),
        (with(6, "vertex 0 0 0"), "line 7: a facet has three corners, and this is a fourth"),
        (with(8, "color 1 0 0"), "line 9: no line of an STL file"),
        (with(3, "vertex 0 nan 0"), "corner of triangle 1 "),
        (with(3, "vertex 0 1e7 0"), "corner of triangle 1 "),
    ] {
        let told = refused(&file);
        assert!(told.contains(wanted), "{told}");
    }
    // A file that was cut off is neither: its length is not that of its header.
    let whole = binary(&cuboid(1.0, 1.0, 1.0));
    let told = refused(&whole[..whole.len() - 7]);
    assert!(told.contains("677 bytes"), "{told}");
}
