//! An optical bench: flat things before a still camera.

use geometry::{Rig, TriangleMesh};
use nalgebra::{Isometry3, Point3, Vector3};
use wire::{Frame, Light};
use world::optics::{CameraModelSim, Workspace};
use world::{HandSection, Scene, Surface};

pub const LASER: Light = Light { laser: true, lamp: false };
pub const LAMP: Light = Light { laser: false, lamp: true };
pub const ROOM: Light = Light { laser: false, lamp: false };

/// No noise, no speckle, a response without gamma, and a gain of 1.
pub const CLEAN: &str = "
laser = { speckle_contrast = 0 }
sensor = { full_well_electrons = 1e9, read_noise_electrons = 0, gamma = 1 }
gain = { automatic = false }
";

/// A handset with a bent lens and this under `[simulation.optics]`.
pub fn rig(optics: &str) -> Rig {
    let text = format!(
        r#"
        [camera]
        width = 320
        height = 240
        fx = 500.0
        fy = 499.0
        cx = 161.2
        cy = 118.4
        distortion = [-0.11, 0.08, 6e-4, -4e-4, 0.0]
        [laser]
        normal = [-0.894398213, 0.008049584, 0.447199106]
        distance_m = 0.089439821
        channel_weights = [1.0, 0.0, 0.0]
        peaks_per = "row"
        [body_from_camera]
        translation_m = [0, 0, 0]
        rotation_wxyz = [1, 0, 0, 0]
        [simulation.optics]
        {optics}"#
    );
    Rig::parse(&text).unwrap()
}

/// A white plate with its front towards `normal`.
pub fn plate(centre: [f32; 3], normal: [f32; 3], half_m: f32) -> Surface {
    let normal = Vector3::from(normal).normalize();
    let side = normal.cross(&Vector3::new(0.31, 0.95, 0.0)).normalize();
    let (a, b) = (side * half_m, normal.cross(&side) * half_m);
    let centre = Point3::from(centre);
    let mesh = TriangleMesh {
        vertices: vec![centre - a - b, centre + a - b, centre + a + b, centre - a + b],
        normals: vec![normal; 4],
        colours: vec![[255; 3]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    };
    Surface { name: "plate".into(), mesh, texture: None, specular: 0.0, shininess: 1.0 }
}

/// The world of these tests is the camera's frame.
pub fn scene(surfaces: Vec<Surface>, ambient: f32) -> Scene {
    Scene { surfaces, subject: 0, table: None, ambient, hand: HandSection::default() }
}

pub fn square_on(distance_m: f32) -> Surface {
    plate([0.0, 0.0, distance_m], [0.0, 0.0, -1.0], distance_m)
}

pub fn picture(scene: &Scene, rig: &Rig, light: Light) -> Frame {
    let camera = CameraModelSim::new(scene, rig, 3).unwrap();
    let frame = camera.render(5, &Isometry3::identity(), light, &mut Workspace::default());
    frame.check().unwrap();
    frame
}

/// A channel of a pixel, 0 to 255.
pub fn value(frame: &Frame, column: usize, row: usize, channel: usize) -> f64 {
    f64::from(frame.data[row * frame.stride as usize + 3 * column + channel])
}

/// Mean of a channel over a square of 21 pixels.
pub fn mean(frame: &Frame, column: usize, row: usize, channel: usize) -> f64 {
    let around = |middle: usize| middle - 10..=middle + 10;
    around(row).flat_map(|row| around(column).map(move |column| value(frame, column, row, channel))).sum::<f64>()
        / 441.0
}
