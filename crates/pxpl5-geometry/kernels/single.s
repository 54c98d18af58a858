// The program of Slats (slats_rules.md): makes the commands of both eyes, one triangle after another, like the output of
// a good compiler of about 1990 for a plain single-precision program in C.
//
// Registers on entry in addition to parameters.s: r19 address for command words of the right eye, r21 parameter block
// of the right eye. r18 and r20 belong to the left eye. On return: r18 and r19 are the addresses after the last command
// of each eye.
//
// The arithmetic and its order are the same as in src/single.rs.

// ---- stack frame; the corners have the places of scalar.s, and the depth and the surface are singles
SAVE    = 0       // return address
LEFT_OUT = 4      // for each eye, left 2 and right 1: corners that are left to the clipper
LIMITED = 8       // for each eye in the same way: corners beyond the guard band
PARALLEL = 12     // 1 if the eyes are parallel
EYE     = 144     // bytes from the corners of the left eye to the corners of the right eye
PLACES  = 384     // address of an eye's corners
SURFACES = 388    // offset of the surfaces, which both eyes share, from these corners
PERROW  = 60      // twice the slope per pixel of scalar.s, because a row has two lines

// Exchanges the commands and the parameter blocks of the eyes.
        .macro  othereye
        mov     r18, r7
        mov     r19, r18
        mov     r7, r19
        mov     r20, r7
        mov     r21, r20
        mov     r7, r21
        .endm

// Computes a reciprocal in single precision: a seed and two Newton steps. Changes f10 and f12.
        .macro  inverse of, to
        fld.l   P_TWO_S(r20), f10
        frcp.ss \of, \to
        .rept   2
        fmul.ss \of, \to, f12
        fsub.ss f10, f12, f12
        fmul.ss \to, f12, \to
        .endr
        .endm

        .align  32
start:  st.l    r1, SAVE(r2)
        // Two eyes are parallel if the rows y, z and w of their matrices are equal.
        mov     r20, r5
        mov     r21, r6
        mov     12, r4
        mov     r0, r9
equal:  ld.l    P_ROWS+16(r5), r7
        ld.l    P_ROWS+16(r6), r8
        adds    4, r5, r5
        adds    4, r6, r6
        btne    r7, r8, askew
        adds    -1, r4, r4
        btne    r0, r4, equal
        mov     1, r9
askew:  st.l    r9, PARALLEL(r2)

next:   mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
        mov     r0, r23
        mov     r0, r24
each:   call    corner
        nop
        call    colour
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, each
        st.l    r23, LEFT_OUT(r2)
        st.l    r24, LIMITED(r2)
        adds    CORNERS, r2, r7
        st.l    r7, PLACES(r2)
        mov     C_SURFACE, r10
        st.l    r10, SURFACES(r2)
        mov     2, r3
eye:    ld.l    LEFT_OUT(r2), r10
        ld.l    PLACES(r2), r7
        and     r3, r10, r10
        btne    r0, r10, clip
        // orientation
        fld.d   C_X(r7), f8
        adds    C_BYTES, r7, r8
        fld.d   C_X(r8), f10
        adds    C_BYTES, r8, r9
        fld.d   C_X(r9), f12
        fsub.ss f10, f8, f16                // dx, dy to corner 1, to corner 2
        fsub.ss f11, f9, f17
        fsub.ss f12, f8, f18
        fsub.ss f13, f9, f19
        fmul.sd f16, f19, f20
        fmul.sd f17, f18, f22
        fsub.dd f20, f22, f20
        pfeq.dd f20, f0, f0
        bc      done                        // nothing to draw
        facing_float f21, done
        pfgt.dd f0, f20, f0
        bnc     oriented
        fmov.ss f16, f24                    // change to clockwise order
        fmov.ss f18, f16
        fmov.ss f24, f18
        fmov.ss f17, f24
        fmov.ss f19, f17
        fmov.ss f24, f19
        fsub.dd f0, f20, f20
        mov     r8, r10
        mov     r9, r8
        mov     r10, r9
oriented: fst.l f16, DX1(r2)
        fst.l   f17, DY1(r2)
        fst.l   f18, DX2(r2)
        fst.l   f19, DY2(r2)
        // Values that all planes share: slopes per unit of a cross product, and the way to the middle of pixel (0, 0).
        fmov.ds f20, f23
        inverse f23, f11
        orh     0x4180, r0, r10             // 16.0
        ixfr    r10, f13
        orh     0x4100, r0, r10             // 8.0
        ixfr    r10, f12
        fld.l   P_SIXTEENTH_S(r20), f14
        fmul.ss f11, f13, f11
        fld.l   P_THIRTY_SECOND(r20), f15
        fst.l   f11, PERPIX(r2)
        fadd.ss f11, f11, f11
        fst.l   f11, PERROW(r2)
        fsub.ss f12, f8, f8
        fmul.ss f8, f14, f8
        fst.l   f8, TOX(r2)
        fsub.ss f12, f9, f9
        fmul.ss f9, f15, f9
        fst.l   f9, TOY(r2)
        // edges
        ld.l    LIMITED(r2), r10
        nop
        and     r3, r10, r10
        btne    r0, r10, beyondband
        mov     r7, r10
        mov     r8, r11
        call    edge
        adds    8, r18, r12
        mov     r8, r10
        mov     r9, r11
        call    edge
        adds    24, r18, r12
        mov     r9, r10
        mov     r7, r11
        call    edge
        adds    40, r18, r12
edged:  adds    C_DEPTH, r0, r10
        call    plane
        adds    56, r18, r11
        ld.l    SURFACES(r2), r10
        call    plane
        adds    76, r18, r11
        ld.l    SURFACES(r2), r10
        adds    92, r18, r11
        call    plane
        adds    4, r10, r10
        ld.l    SURFACES(r2), r10
        adds    108, r18, r11
        call    plane
        adds    8, r10, r10
        // Store the instruction heads.
        ld.l    P_HEADS(r20), r10
        ld.l    P_HEADS+4(r20), r11
        st.l    r10, 0(r18)
        ld.l    P_HEADS+8(r20), r10
        st.l    r11, 4(r18)
        st.l    r11, 20(r18)
        st.l    r11, 36(r18)
        ld.l    P_HEADS+12(r20), r11
        st.l    r10, 52(r18)
        ld.l    P_HEADS+16(r20), r10
        st.l    r11, 68(r18)
        ld.l    P_HEADS+20(r20), r11
        st.l    r10, 72(r18)
        ld.l    P_HEADS+24(r20), r10
        st.l    r11, 88(r18)
        st.l    r10, 104(r18)
        adds    COMMAND_BYTES, r18, r18
done:   othereye
        ld.l    PLACES(r2), r7
        mov     C_SURFACE-EYE, r8
        st.l    r8, SURFACES(r2)
        adds    EYE, r7, r7
        adds    -1, r3, r3
        st.l    r7, PLACES(r2)
        btne    r0, r3, eye
        adds    -1, r17, r17
        adds    LIST_STEP, r16, r16
        nextorclip
beyondband: mov r7, r10
        mov     r8, r11
        call    limitededge
        adds    8, r18, r12
        mov     r8, r10
        mov     r9, r11
        call    limitededge
        adds    24, r18, r12
        mov     r9, r10
        mov     r7, r11
        call    limitededge
        adds    40, r18, r12
        br      edged
        nop

// Jumps to `distant` unless a coordinate is at most f8 and at least f9.
        .macro  withinband at, distant
        pfle.ss \at, f8, f0
        bc      \distant
        pfle.ss f9, \at, f0
        bc      \distant
        .endm

// ---- corner: stores the positions and depths of the vertex at r5 in the structures of both eyes. The left eye's
// structure is at r6. The eye's bit is set in r23 if the corner is left to the clipper, and in r24 if the corner is
// beyond the guard band.
corner: fld.l   0(r5), f16
        fld.l   4(r5), f17
        fld.l   8(r5), f18
        mov     2, r3
view:   fld.l   P_ROWS(r20), f8
        fld.l   P_ROWS+4(r20), f9
        clipped 0, f20
        clipped 1, f21
        clipped 2, f22
        clipped 3, f23
        fld.l   P_LEAST_W(r20), f8
        within  f0, f22                     // not below the near plane
        within  f8, f23
        inverse f23, f11
        fld.l   P_SCREEN(r20), f14
        fmul.ss f20, f11, f20               // rounded to subpixels
        fld.l   P_SCREEN+8(r20), f24
        fmul.ss f20, f14, f20
        fld.l   P_ROUND_S(r20), f26
        fadd.ss f20, f24, f20
        fld.l   P_SCREEN+4(r20), f15
        fsub.ss f20, f26, f20
        fld.l   P_SCREEN+12(r20), f25
        fst.l   f20, C_X(r6)
        fmul.ss f21, f11, f21
        fld.l   P_FIELD_ROUND(r20), f27
        fmul.ss f21, f15, f21
        fadd.ss f21, f25, f21
        fsub.ss f21, f27, f21               // from the first line of the field
        fst.l   f21, C_Y(r6)
        fld.l   P_DEPTH_SCALE(r20), f13
        fmul.ss f11, f13, f12
        fmul.ss f22, f12, f22
        pfgt.ss f22, f13, f0                // depth, at most far
        bnc     nearer
        fmov.ss f13, f22
nearer: fld.l   P_NEAR_S(r20), f10
        fadd.ss f22, f10, f22
        fst.l   f22, C_DEPTH(r6)
        fld.l   P_BAND(r20), f8
        fsub.ss f0, f8, f9
        withinband f20, distant
        withinband f21, distant
turn:   adds    -1, r3, r3
        ld.l    PARALLEL(r2), r10
        bte     r0, r3, seen
        btne    r0, r10, aside
        mov     r20, r7
        mov     r21, r20
        mov     r7, r21
        br      view
        adds    EYE, r6, r6
seen:   mov     r20, r7
        mov     r21, r20
        mov     r7, r21
        adds    -EYE, r6, r6
both:   bri     r1
        nop
// The right eye of parallel eyes: only the row x is its own.
aside:  fld.l   P_ROWS(r21), f8
        fld.l   P_ROWS+4(r21), f9
        fmul.ss f8, f16, f20
        fld.l   P_ROWS+8(r21), f10
        fmul.ss f9, f17, f12
        fld.l   P_ROWS+12(r21), f13
        fadd.ss f20, f12, f20
        fmul.ss f10, f18, f12
        fadd.ss f20, f12, f20
        fadd.ss f20, f13, f20
        fmul.ss f20, f11, f20
        fmul.ss f20, f14, f20
        fadd.ss f20, f24, f20
        fsub.ss f20, f26, f20
        fst.l   f20, C_X+EYE(r6)
        fst.l   f21, C_Y+EYE(r6)
        fst.l   f22, C_DEPTH+EYE(r6)
        fld.l   P_BAND(r20), f8
        fsub.ss f0, f8, f9
        withinband f20, distant
        withinband f21, distant
        bri     r1
        nop
// A corner beyond the guard band, or farther away than the code can limit it.
distant: or     r3, r24, r24
        orh     0x5380, r0, r10             // 2^40
        ixfr    r10, f8
        ld.l    PARALLEL(r2), r10
        nop
        fsub.ss f0, f8, f9
        withinband f20, toofar
        withinband f21, toofar
limited: btne   1, r3, turn
        btne    r0, r10, both               // the right eye of parallel eyes
        br      turn
        nop
toofar: br      limited
        or      r3, r23, r23
// A corner below the near plane, which parallel eyes share.
beyond: ld.l    PARALLEL(r2), r10
        or      r3, r23, r23
        bte     r0, r10, turn
        or      1, r23, r23
        bri     r1
        nop

// ---- colour: stores the colour of the vertex at r5 in the structure at r6, and advances r6 to the next structure
colour: ld.l    COLOUR(r5), r8
        mov     16, r9
        mov     -8, r7
        adds    C_SURFACE, r6, r10
        fld.l   P_TWO23(r20), f8
component: shr  r9, r8, r11                 // 8 bits of the colour in units of 1/4096, plus half a unit
        and     255, r11, r11
        shl     12, r11, r11
        or      2048, r11, r11
        orh     0x4B00, r11, r11            // 2^23
        ixfr    r11, f17
        adds    -8, r9, r9
        nop
        fsub.ss f17, f8, f17
        fst.l   f17, 0(r10)
        adds    4, r10, r10
        btne    r9, r7, component           // r7 is the shift after the last component
        adds    C_BYTES, r6, r6
        bri     r1
        nop

// f26 = the greater of f26 and the absolute value of a coordinate.
        .macro  greatest at
        fmov.ss \at, f30
        pfgt.ss f0, \at, f0
        bnc     positive\@
        fsub.ss f0, \at, f30
positive\@: pfgt.ss f30, f26, f0
        bnc     lower\@
        fmov.ss f30, f26
lower\@:
        .endm

// ---- edge like `edge`, but its corners can be beyond the guard band. If their greatest coordinate is beyond it, the
// coefficients are multiplied by the guard band divided by this coordinate.
limitededge: fld.d C_X(r10), f8
        fld.d   C_X(r11), f10
        orh     0x4020, r0, r13             // 8.0, double
        ixfr    r0, f28
        ixfr    r13, f29
        fmov.sd f8, f12
        fmov.sd f9, f14
        fmov.sd f10, f16
        fmov.sd f11, f18
        fsub.dd f12, f28, f12
        fsub.dd f14, f28, f14
        fsub.dd f16, f28, f16
        fsub.dd f18, f28, f18
        fmul.dd f12, f18, f20
        fmul.dd f16, f14, f22
        fsub.dd f20, f22, f20               // the constant, dx, dy
        fsub.dd f16, f12, f22
        fsub.dd f18, f14, f24
        fmov.ss f0, f26
        greatest f8
        greatest f9
        greatest f10
        greatest f11
        adds    P_TIE_IN, r0, r14           // a top or a left edge?
        pfgt.dd f0, f24, f0
        bc      owner
        pfeq.dd f24, f0, f0
        bnc     other
        pfgt.dd f22, f0, f0
        bc      owner
other:  adds    P_TIE_OUT, r0, r14
owner:  fld.l   P_BAND(r20), f8
        pfgt.ss f26, f8, f0
        bnc     finite
        inverse f26, f11
        fmul.ss f11, f8, f8
        fmov.sd f8, f10
        fmul.dd f20, f10, f20
        fmul.dd f22, f10, f22
        fmul.dd f24, f10, f24
        orh     0x4210, r0, r13             // the constant is at most 2^34, which becomes 2^30
        ixfr    r0, f8
        ixfr    r13, f9
        pfgt.dd f20, f8, f0
        bnc     below
        fmov.dd f8, f20
below:  fsub.dd f0, f8, f8
        pfgt.dd f8, f20, f0
        bnc     finite
        fmov.dd f8, f20
finite: fld.d   P_ROUND(r20), f28
        adds    r14, r20, r14
        fld.d   0(r14), f10
        fadd.dd f20, f28, f20
        fsub.dd f20, f28, f20
        fld.d   P_SIXTEENTH(r20), f12
        fadd.dd f20, f10, f20
        fadd.dd f22, f28, f22
        fxfr    f22, r13
        fmul.dd f20, f12, f20
        adds    r13, r13, r13
        fadd.dd f24, f28, f24
        fxfr    f24, r14
        st.l    r13, 4(r12)
        fadd.dd f20, f28, f20
        subs    r0, r14, r14
        fxfr    f20, r13
        st.l    r14, 0(r12)
        bri     r1
        st.l    r13, 8(r12)
