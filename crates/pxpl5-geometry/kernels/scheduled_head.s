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
