//! Host time of a board for three cases: a field of ten regions (as Slats sends for an eye), a field without messages,
//! and a picture.

#![allow(missing_docs, reason = "the macros of criterion make public functions without any")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pxpl5_framebuffer::{FrameBuffer, FrameBufferConfig, FrameBufferEvent};
use pxpl5_sim::{Context, Span, Time};
use pxpl5_wire::{
    CopyTarget, FieldParity, Lines, NodeId, PeriodNumber, PictureNumber, PixelSource, RegionGrid, RegionId,
    RegionPixels, Word,
};
use std::hint::black_box;
use std::sync::Arc;

const NODE: NodeId = NodeId(3);

#[derive(Debug)]
struct Flat(Arc<[Word]>);

impl PixelSource for Flat {
    fn pixels(&self) -> Arc<[Word]> {
        Arc::clone(&self.0)
    }
}

type Out = Context<FrameBufferEvent, pxpl5_framebuffer::FrameBufferOutput>;

fn handle(board: &mut FrameBuffer, context: &mut Out, at: Time, event: FrameBufferEvent) {
    board.handle(event, context.at(at));
    context.drain_events();
    black_box(context.drain_outputs().count());
}

fn retrace(board: &mut FrameBuffer, context: &mut Out, field: PeriodNumber) -> Time {
    let at = board.video().retrace(field);
    handle(board, context, at, FrameBufferEvent::Retrace { field });
    at
}

fn copy_field(board: &mut FrameBuffer, context: &mut Out, field: PeriodNumber, image: &Arc<dyn PixelSource>) {
    let buffer = (field.0 % 2) as u8;
    let lines = Lines::Field(FieldParity::of_field(field.next()));
    let mut at = retrace(board, context, field);
    for region in 0..10 {
        let grid = RegionGrid::FIELD;
        let target = CopyTarget {
            frame_buffer: NODE,
            buffer,
            lines,
            grid,
            region: RegionId(region),
            picture: PictureNumber(field.0),
        };
        for part in 0..15 {
            at += Span::from_us(52);
            let pixels = RegionPixels { target, image: Arc::clone(image), part, parts: 15 };
            handle(board, context, at, FrameBufferEvent::Pixels(pixels));
        }
    }
    handle(board, context, at, FrameBufferEvent::SwapRequested { buffer });
}

fn fields(criterion: &mut Criterion) {
    let image: Arc<dyn PixelSource> = Arc::new(Flat(vec![0x123456; 128 * 120].into()));
    let mut group = criterion.benchmark_group("fields");
    group.throughput(Throughput::Elements(1));
    let new = || {
        (
            FrameBuffer::new(FrameBufferConfig::NTSC, NODE, Span::from_ns(50)).expect("valid"),
            Context::default(),
            PeriodNumber::FIRST,
        )
    };
    let (mut board, mut context, mut field) = new();
    group.bench_function("ten-regions", |bencher| {
        bencher.iter(|| {
            copy_field(&mut board, &mut context, field, &image);
            field = field.next();
        });
    });
    group.bench_function("picture", |bencher| {
        let (mut board, mut context, _) = new();
        PeriodNumber::FIRST
            .until(PeriodNumber(4))
            .for_each(|field| copy_field(&mut board, &mut context, field, &image));
        let seen = board.last_seen().expect("scanned");
        bencher.iter(|| seen.picture());
    });
    let (mut board, mut context, mut field) = new();
    group.bench_function("idle", |bencher| {
        bencher.iter(|| {
            retrace(&mut board, &mut context, field);
            field = field.next();
        });
    });
    group.finish();
}

criterion_group!(benches, fields);
criterion_main!(benches);
