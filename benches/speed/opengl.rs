//! The installed OpenGL, measured in a separate process (scripts/llvmpipe).

use crate::timing::Fallible;
use pphigs::EyeView;
use pxpl5::scene::Scene;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// A process that draws views of a scene.
pub(crate) struct OpenGl {
    process: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
    /// Name of the renderer, as OpenGL reports it.
    pub(crate) renderer: String,
    /// Number of pixels covered in the last view.
    pub(crate) covered: f64,
    views: f64,
}

impl OpenGl {
    /// Starts the program with one thread, and sends it a scene and views of the scene.
    pub(crate) fn new(program: &str, scene: &Scene, views: &[EyeView]) -> Fallible<Self> {
        let mut command = Command::new(program);
        command.envs([("LIBGL_ALWAYS_SOFTWARE", "1"), ("GALLIUM_DRIVER", "llvmpipe"), ("LP_NUM_THREADS", "0")]);
        let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let (Some(mut requests), Some(answers)) = (process.stdin.take(), process.stdout.take()) else {
            return Err(format!("{program}: no pipes").into());
        };
        requests.write_all(&input(scene, views))?;
        let mut answers = BufReader::new(answers);
        let renderer = line(&mut answers)?;
        Ok(Self { process, requests, answers, renderer, covered: 0.0, views: views.len() as f64 })
    }

    /// Draws all views and returns the CPU time of one view, in seconds.
    pub(crate) fn draw(&mut self) -> Fallible<f64> {
        self.requests.write_all(b"d")?;
        let answer = line(&mut self.answers)?;
        let mut numbers = answer.split(' ').map(str::parse::<f64>);
        let (Some(Ok(seconds)), Some(Ok(covered))) = (numbers.next(), numbers.next()) else {
            return Err(format!("OpenGL: expected seconds and pixels, found {answer:?}").into());
        };
        self.covered = covered;
        Ok(seconds / self.views)
    }
}

impl Drop for OpenGl {
    fn drop(&mut self) {
        // The process has no data to save, so an error is ignored.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn line(answers: &mut impl BufRead) -> Fallible<String> {
    let mut line = String::new();
    match answers.read_line(&mut line)? {
        0 => Err("OpenGL: the process ended, see what it says".into()),
        _ => Ok(line.trim().to_owned()),
    }
}

/// Returns the mesh and the views in the format of the program.
fn input(scene: &Scene, views: &[EyeView]) -> Vec<u8> {
    let light = scene.lighting();
    let counts = [scene.vertices().len(), scene.triangles().len(), views.len()].map(|count| count as u32);
    let lighting = [light.towards_light.to_array().as_slice(), &[light.ambient, light.diffuse]].concat();
    let vertices = scene.vertices().iter().flat_map(|vertex| {
        let [red, green, blue] = vertex.colour;
        let place = [vertex.position, vertex.normal].into_iter().flat_map(|v| v.to_array());
        let place: Vec<u8> = place.flat_map(f32::to_le_bytes).collect();
        place.into_iter().chain([red, green, blue, 255])
    });
    let corners = scene.triangles().iter().flatten().flat_map(|corner| corner.to_le_bytes());
    let matrices = views.iter().flat_map(|view| (view.projection * view.world_to_eye).to_cols_array());
    let mut bytes: Vec<u8> = counts.into_iter().flat_map(u32::to_le_bytes).collect();
    bytes.extend(lighting.into_iter().flat_map(f32::to_le_bytes));
    bytes.extend(vertices);
    bytes.extend(corners);
    bytes.extend(matrices.flat_map(f32::to_le_bytes));
    bytes
}
