//! A helper of `scripts/speed`: it draws one eye's picture of a mesh with the installed OpenGL, in memory. With
//! `LIBGL_ALWAYS_SOFTWARE` set, OpenGL is Mesa's llvmpipe. The first line of the output names the OpenGL renderer.
//!
//! The input is little-endian. It begins with the numbers of vertices, triangles and views (u32 each). Then follow the
//! direction to the light, ambient and diffuse light (5 f32). Each vertex has position and normal (6 f32) and a colour
//! (4 bytes). Each triangle has three vertex indices (u32). Each view has its matrix from world to clip coordinates, by
//! columns (16 f32). Each further byte draws all views once: 640 x 480 pixels, Gouraud shading, Z buffer. The program
//! answers with one line: CPU time of this process in seconds, and number of covered pixels in the last view.

use cpu_time::ProcessTime;
use glow::HasContext;
use std::error::Error;
use std::io::{Read, Write};

type Fallible<T> = Result<T, Box<dyn Error>>;

const WIDTH: i32 = 640;
const HEIGHT: i32 = 480;
const VERTEX_BYTES: usize = 28;

const VERTEX: &str = "#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
uniform mat4 matrix;
uniform vec3 towards_light;
uniform vec2 light;
out vec3 lit;
void main() {
    lit = colour * min(light.x + light.y * max(dot(normal, towards_light), 0.0), 1.0);
    gl_Position = matrix * vec4(position, 1.0);
}";

const FRAGMENT: &str = "#version 330 core
in vec3 lit;
out vec4 pixel;
void main() { pixel = vec4(lit, 1.0); }";

fn main() -> Fallible<()> {
    let gl = context()?;
    // SAFETY: the context is current on this thread, the only one.
    println!("{}", unsafe { gl.get_parameter_string(glow::RENDERER) });
    let mut input = std::io::stdin().lock();
    // SAFETY: as above.
    let picture = unsafe { Picture::new(&gl, &mut input)? };
    let mut request = [0];
    while input.read(&mut request)? == 1 {
        let begin = ProcessTime::try_now()?;
        // SAFETY: as above.
        unsafe { picture.draw(&gl) };
        let seconds = begin.try_elapsed()?.as_secs_f64();
        println!("{seconds} {}", unsafe { covered(&gl) });
        std::io::stdout().flush()?;
    }
    Ok(())
}

/// A context without a window, current for ever.
fn context() -> Fallible<glow::Context> {
    /// EGL_PLATFORM_SURFACELESS_MESA, of EGL_MESA_platform_surfaceless.
    const SURFACELESS: khronos_egl::Enum = 0x31DD;
    // SAFETY: the library with the name libEGL implements EGL.
    let egl = unsafe { khronos_egl::DynamicInstance::<khronos_egl::EGL1_5>::load_required()? };
    // SAFETY: this platform takes the default display, and no attributes.
    let display =
        unsafe { egl.get_platform_display(SURFACELESS, khronos_egl::DEFAULT_DISPLAY, &[khronos_egl::ATTRIB_NONE])? };
    egl.initialize(display)?;
    egl.bind_api(khronos_egl::OPENGL_API)?;
    let wanted =
        [khronos_egl::RENDERABLE_TYPE, khronos_egl::OPENGL_BIT, khronos_egl::SURFACE_TYPE, 0, khronos_egl::NONE];
    let config =
        egl.choose_first_config(display, &wanted)?.ok_or("EGL: expected a configuration for OpenGL, found none")?;
    let version = [khronos_egl::CONTEXT_MAJOR_VERSION, 3, khronos_egl::CONTEXT_MINOR_VERSION, 3, khronos_egl::NONE];
    let context = egl.create_context(display, config, None, &version)?;
    egl.make_current(display, None, None, Some(context))?;
    // SAFETY: functions of the current context.
    let gl = unsafe {
        glow::Context::from_loader_function(|name| {
            egl.get_proc_address(name).map_or(std::ptr::null(), |f| f as *const _)
        })
    };
    // The library must stay loaded after this function.
    std::mem::forget(egl);
    Ok(gl)
}

/// The mesh and the views that are drawn.
struct Picture {
    indices: i32,
    matrices: Vec<[f32; 16]>,
    matrix: Option<glow::UniformLocation>,
}

impl Picture {
    /// Takes the mesh and the views in.
    ///
    /// # Safety
    ///
    /// The context is current.
    unsafe fn new(gl: &glow::Context, input: &mut impl Read) -> Fallible<Self> {
        let [vertices, triangles, views] = numbers(input, u32::from_le_bytes)?;
        let [x, y, z, ambient, diffuse] = numbers(input, f32::from_le_bytes)?;
        let held = bytes(input, vertices as usize * VERTEX_BYTES)?;
        let corners = bytes(input, triangles as usize * 12)?;
        let matrices = (0..views).map(|_| numbers(input, f32::from_le_bytes)).collect::<Fallible<_>>()?;
        unsafe {
            target(gl)?;
            let program = program(gl)?;
            gl.use_program(Some(program));
            let place = |name| gl.get_uniform_location(program, name);
            gl.uniform_3_f32(place("towards_light").as_ref(), x, y, z);
            gl.uniform_2_f32(place("light").as_ref(), ambient, diffuse);
            // Copy the mesh into buffers of OpenGL once.
            gl.bind_vertex_array(Some(gl.create_vertex_array()?));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer()?));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, &held, glow::STATIC_DRAW);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(gl.create_buffer()?));
            gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, &corners, glow::STATIC_DRAW);
            let stride = VERTEX_BYTES as i32;
            // Describe the layout of a vertex: position, normal and colour.
            for (index, kind, normalised, offset) in
                [(0, glow::FLOAT, false, 0), (1, glow::FLOAT, false, 12), (2, glow::UNSIGNED_BYTE, true, 24)]
            {
                gl.vertex_attrib_pointer_f32(index, 3, kind, normalised, stride, offset);
                gl.enable_vertex_attrib_array(index);
            }
            gl.enable(glow::DEPTH_TEST);
            gl.viewport(0, 0, WIDTH, HEIGHT);
            gl.clear_color(0.0, 0.0, 0.0, 0.0);
            Ok(Self { indices: 3 * triangles as i32, matrices, matrix: place("matrix") })
        }
    }

    /// Draws all views, each to its end.
    ///
    /// # Safety
    ///
    /// The context is current.
    unsafe fn draw(&self, gl: &glow::Context) {
        for matrix in &self.matrices {
            unsafe {
                gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
                gl.uniform_matrix_4_f32_slice(self.matrix.as_ref(), false, matrix);
                gl.draw_elements(glow::TRIANGLES, self.indices, glow::UNSIGNED_INT, 0);
                gl.finish();
            }
        }
    }
}

/// Colour of 8 bits and depth of 24, in memory.
unsafe fn target(gl: &glow::Context) -> Fallible<()> {
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(gl.create_framebuffer()?));
        for (format, place) in
            [(glow::RGBA8, glow::COLOR_ATTACHMENT0), (glow::DEPTH_COMPONENT24, glow::DEPTH_ATTACHMENT)]
        {
            let held = gl.create_renderbuffer()?;
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(held));
            gl.renderbuffer_storage(glow::RENDERBUFFER, format, WIDTH, HEIGHT);
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, place, glow::RENDERBUFFER, Some(held));
        }
        let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
        let is_complete = status == glow::FRAMEBUFFER_COMPLETE;
        is_complete
            .then_some(())
            .ok_or_else(|| format!("OpenGL: expected a complete frame buffer, found {status:#x}").into())
    }
}

unsafe fn program(gl: &glow::Context) -> Fallible<glow::Program> {
    unsafe {
        let program = gl.create_program()?;
        // Compile both shaders, then link them.
        for (kind, source) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, FRAGMENT)] {
            let shader = gl.create_shader(kind)?;
            gl.shader_source(shader, source);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                return Err(gl.get_shader_info_log(shader).into());
            }
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            return Err(gl.get_program_info_log(program).into());
        }
        Ok(program)
    }
}

/// Pixels that something was drawn on.
unsafe fn covered(gl: &glow::Context) -> usize {
    let mut pixels = vec![0; (WIDTH * HEIGHT * 4) as usize];
    let into = glow::PixelPackData::Slice(Some(&mut pixels));
    unsafe { gl.read_pixels(0, 0, WIDTH, HEIGHT, glow::RGBA, glow::UNSIGNED_BYTE, into) };
    pixels.chunks(4).filter(|pixel| pixel[3] != 0).count()
}

fn bytes(input: &mut impl Read, count: usize) -> Fallible<Vec<u8>> {
    let mut bytes = vec![0; count];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn numbers<T: Copy + Default, const N: usize>(input: &mut impl Read, from: fn([u8; 4]) -> T) -> Fallible<[T; N]> {
    let mut numbers = [T::default(); N];
    for number in &mut numbers {
        let mut bytes = [0; 4];
        input.read_exact(&mut bytes)?;
        *number = from(bytes);
    }
    Ok(numbers)
}
