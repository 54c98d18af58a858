// Macros and constants for two kinds of display lists: triangles with separate corners, and strips.

// The end of a loop over triangles: continues with the next triangle, or returns. The code at `clip` handles triangles
// that are not completely inside the guard band.
        .macro  nextorclip
        btne    r0, r17, next
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop
clip:   ld.l    P_CLIPPER(r20), r6
        nop
        calli   r6
        nop
        br      done
        nop
        .endm

.if STRIPS
// A display list of strips: each vertex makes a triangle with the two vertices before it, unless a strip begins there.

LIST_STEP    = VERTEX_BYTES     // bytes from one triangle to the next, which share two corners
RECORD       = 56
RECORD_STEP  = RECORD           // bytes from the records of one triangle to the records of the next
BATCH_TRIANGLES = 76            // a batch has 78 corners

// Converts the number of vertices to the number of triangles.
        .macro  counted
        adds    -2, r17, r17
        .endm

// Each turn of the loop over corners makes three records, until there are two more records than triangles.
        .macro  turns
        adds    1, r31, r30
        .endm
        .macro  morecorners
        d.fnop
            adds    3*RECORD, r6, r6
        d.fnop
            adds    -3, r30, r30
        d.fnop
            nop
        d.fnop
            bnc     corners
        .endm

// Leaves out the triangle if its last corner begins a strip.
        .macro  passover
        d.fnop
            ld.l    R_BEGINS(r5), r8
        d.fnop
            nop
        d.fnop
            btne    r0, r8, passed
        .endm
        .macro  passover_straight
        ld.l    2*VERTEX_BYTES+BEGINS(r16), r8
        btne    r0, r8, done
        .endm

        .macro  doubtful to
        ld.l    R_DOUBT(r3), \to
        ld.l    R_DOUBT(r4), r9
        ld.l    R_DOUBT(r5), r10
        or      r9, \to, \to
        or      r10, \to, \to
        .endm
        .macro  decided
        st.l    r0, R_DOUBT(r3)
        st.l    r0, R_DOUBT(r4)
        st.l    r0, R_DOUBT(r5)
        .endm

// Vertices in doubt are found only at the end of the loop. A test here would take three more words, which cost more
// time than they save.
        .macro  doubtfulpairs
        .endm
.else
// A display list of triangles with separate corners.

LIST_STEP    = TRIANGLE_BYTES   // bytes from one triangle to the next
RECORD_STEP  = 144              // bytes from the records of one triangle to the records of the next
RECORD       = 48
BATCH_TRIANGLES = 26

        .macro  counted
        .endm

// Each turn of the loop over corners makes the records of one triangle.
        .macro  turns
        mov     r31, r30
        .endm
        .macro  morecorners
        d.fnop
            adds    -1, r30, r30
        d.fnop
            adds    RECORD_STEP, r6, r6
        d.fnop
            btne    r0, r30, corners
        .endm

        .macro  passover
        .endm
        .macro  passover_straight
        .endm

        .macro  doubtful to
        ld.l    R_DOUBT(r3), \to
        .endm
        .macro  decided
        st.l    r0, R_DOUBT(r3)
        .endm

// The same test in instruction pairs, at the beginning of the second loop. Triangles in doubt leave the loop here.
        .macro  doubtfulpairs
        d.fnop
            ld.l    R_DOUBT(r3), r8
        d.fnop
            nop
        d.fnop
            shr     31, r8, r8
        d.fnop
            btne    r0, r8, slow
        .endm
.endif
