// The kernel of dual-instruction code (Schedule::Dual). Its parts are dual.s, vertices.s, vertices_surface.s, vertices_end.s, setup.s,
// bins.s, dual_end.s and, for both eyes, right_eye.s.

.if PHONG
COMMAND_BYTES = 128
.else
COMMAND_BYTES = 120
.endif

.if BOTH_EYES
// A batch is done when both loops have been gone through for the left eye and then for the right one (slats_rules.md).
//
// Registers on entry besides those of parameters.s: r19 where command words of the right eye go, r21 its parameter block; r18 and r20 are
// those of the left eye. On return: r18 and r19 behind the last command of either eye.

// ---- stack frame
BATCH   = 464       // triangles of the batch
TURN    = 468       // 0 while the left eye's commands are made, 1 while the right eye's are

        .macro  lefteye
        st.l    r0, TURN(r2)
        .endm
        .macro  batchnoted
        st.l    r31, BATCH(r2)
        .endm
        .macro  nexteye
        mov     r18, r7
        mov     r19, r18
        mov     r7, r19
        mov     r20, r7
        mov     r21, r20
        mov     r7, r21
        ld.l    TURN(r2), r8
        ld.l    BATCH(r2), r31
        xor     1, r8, r8
        st.l    r8, TURN(r2)
        btne    r0, r8, righteye
        .endm
.else
// A batch is done when both loops have been gone through once, for one eye.

        .macro  lefteye
        .endm
        .macro  batchnoted
        .endm
        .macro  nexteye
        .endm
.endif

// Triangles in dual-instruction mode, in batches: a first loop takes their corners to records, a second one takes the
// records to the words of a command and to the bin of the region. Each loop fits the 4 KB instruction cache, the records of a batch fit the data
// cache. Both are linear code (i860::linear) without a branch: what depends on the triangle is chosen by masks and by places in tables.
// Triangles in doubt (near the planes of the clipper, without area, in more than one region) leave the loop.
//
// Arithmetic and its order are those of the native transform and set-up; 1 / area is formed by Newton steps in double precision.

// ---- stack frame
SAVE    = 0         // return address
LEFT    = 4         // triangles left in the batch, while others use its register
BOX     = 40        // low x, high x, low y, high y
SCRATCH = 64        // 16 bytes for each corner
RECORDS = 512

        .macro  edgeword k, n, to
        ld.l    8+16*\k+4*\n(r18), \to
        .endm

        .pool   r1 r7 r8 r9 r10 r11 r12 r13 r14 r15 r22 r23 r26 r27 r28

        .align  32
start:  st.l    r1, SAVE(r2)
        counted
        lefteye
batch:  mov     BATCH_TRIANGLES, r31
        subs    r17, r31, r0
        bnc     begun                       // a batch at least
        mov     r17, r31
begun:  batchnoted
        turns
        mov     r16, r29
        adds    RECORDS, r2, r6
        .align  8
        d.fnop
            nop
corners:
// Three corners at r29 to the records at r6: relative to the eye, w and its reciprocal by seed and two Newton steps in single precision,
// the other coordinates, snapped and turned round, depth, whether it may lie outside of the depths, and the surface.
//
// A record: x and y, snapped, as singles of 1.5 * 2^23 and more; 8 - x and 8 - y in the same way; depth as a double of
// 1.5 * 2^52 and more; of the first corner alone the place of the triangle's side in the table of sides, and a word that is
// negative where the exact tests must decide; the three words of the surface, as singles of 1.5 * 2^23 and more; the colour.
R_SNAPPED = 0
R_TURNED  = 8
R_DEPTH   = 16
R_SIDE    = 24
R_DOUBT   = 28
R_SURFACE = 32
R_COLOUR  = 44
R_BEGINS  = 48      // in strips alone: not 0 where the vertex makes no triangle with the two before
