// The kernel of dual-instruction code (Schedule::Dual). Its parts are dual.s, vertices.s, vertices_surface.s, vertices_end.s, setup.s,
// bins.s, dual_end.s and, for both eyes, right_eye.s.

.if PHONG
COMMAND_BYTES = 128
.else
COMMAND_BYTES = 120
.endif

.if BOTH_EYES
// Both loops run over a batch for the left eye, and then for the right eye (slats_rules.md).
//
// Registers on entry in addition to parameters.s: r19 address for command words of the right eye, r21 parameter block
// of the right eye. r18 and r20 belong to the left eye. On return: r18 and r19 are the addresses after the last command
// of each eye.

// ---- stack frame
BATCH   = 464       // number of triangles in the batch
TURN    = 468       // 0 while the left eye's commands are made, 1 for the right eye

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
// Both loops run over a batch once, for one eye.

        .macro  lefteye
        .endm
        .macro  batchnoted
        .endm
        .macro  nexteye
        .endm
.endif

// Computes triangles in dual-instruction mode, in batches. A first loop makes records of the corners. A second loop
// makes the words of a command and a bin entry from the records. Each loop fits the instruction cache of 4 KB, and the
// records of a batch fit the data cache. Both loops are linear code (i860::linear) without a branch: masks and
// positions in tables select the parts that depend on the triangle. Triangles in doubt (near the planes of the clipper,
// without area, or in more than one region) leave the loop.
//
// The arithmetic and its order are the same as in the native transform and set-up. 1 / area is computed by Newton steps
// in double precision.

// ---- stack frame
SAVE    = 0         // return address
LEFT    = 4         // triangles left in the batch, while their register has another use
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
        bnc     begun                       // at least one batch
        mov     r17, r31
begun:  batchnoted
        turns
        mov     r16, r29
        adds    RECORDS, r2, r6
        .align  8
        d.fnop
            nop
corners:
// Makes the records at r6 of the three corners at r29. The steps are: position relative to the eye; w, and its
// reciprocal by a seed and two Newton steps in single precision; the other coordinates, rounded to subpixels and also
// subtracted from 8; the depth, and a test of its range; the surface.
//
// A record has x and y in subpixels, as singles biased by 1.5 * 2^23; 8 - x and 8 - y in the same format; the depth as
// a double biased by 1.5 * 2^52. Only the first corner has the position of the triangle's side in the table of sides,
// and a word that is negative if the exact tests must decide. Then follow the three words of the surface, as singles
// biased by 1.5 * 2^23, and the colour.
R_SNAPPED = 0
R_TURNED  = 8
R_DEPTH   = 16
R_SIDE    = 24
R_DOUBT   = 28
R_SURFACE = 32
R_COLOUR  = 44
R_BEGINS  = 48      // only in strips: not 0 if the vertex makes no triangle with the two vertices before it
