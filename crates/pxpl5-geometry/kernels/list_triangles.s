// A display list of triangles, each with corners of its own.

LIST_STEP    = TRIANGLE_BYTES   // from one triangle to the next
RECORD_STEP  = 144              // from the records of one to those of the next
RECORD       = 48
BATCH_TRIANGLES = 26

        .macro  counted
        .endm

// each turn of the loop over corners makes the records of one triangle
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

// the same in pairs, at the beginning of the second loop: what is in doubt does not go through it first
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
