//! Renderer of Pixel-Planes 5: controller, expression evaluator, 128 x 128 pixel array.
