// Code for the beginning of a pass and for edits of the display list. It is like the output of a good compiler of about
// 1990 for plain functions in C (compiled_rules.md). Matrices are singles, column by column, as the host sends them.
// Sums are computed in double precision in the order of the native code, and rounded once. Divisions are Newton steps
// in double precision.
//
//   edit   r16 edits of a message (each has the number of a structure and its model matrix), r17 number of edits, r18
//          model matrices of all structures
//   reset  r16 first addresses of the bins, r17 number of bins, r19 table of bins
//   place  r16 matrix to the eye, r17 model matrix, r18 projection, r19 light (direction towards the light x, y, z;
//          ambient part; diffuse part), r20 parameter block, r21 not 0 if triangles that face away are not drawn, r22
//          parameter block of spheres, or 0 if there are no spheres or the projection cannot show them, r2 stack.
//          Computes the words that depend on the view of a structure. The structure's matrix to the eye must have an
//          inverse. For single.s, the matrix of triangles is not relative to the eye.

MATRIX_BYTES = 64

// ---- stack frame
SAVE    = 0
VECTOR  = 16       // four doubles
PRODUCT = 48       // four doubles
EYE     = 80       // the model-view matrix, singles
ROWS    = 144      // columns of the rows x y z to the eye, doubles: 32 bytes a column
CROSS   = 240      // y x z, z x x, x x y of the columns, doubles
ORIGIN  = 312      // position of the eye, doubles
LINK    = 336      // the return address of `lens`
FRAME   = 352

edit:   bte     r0, r17, edited
each:   ld.l    0(r16), r8
        adds    4, r16, r16
        shl     6, r8, r8
        adds    r18, r8, r9
        mov     16, r10
word:   ld.l    0(r16), r11
        adds    -1, r10, r10
        adds    4, r16, r16
        st.l    r11, 0(r9)
        adds    4, r9, r9
        btne    r0, r10, word
        adds    -1, r17, r17
        btne    r0, r17, each
edited: bri     r1
        nop

reset:  ld.l    0(r16), r8
        adds    -1, r17, r17
        adds    4, r16, r16
        st.l    r8, 0(r19)
        adds    4, r19, r19
        btne    r0, r17, reset
        bri     r1
        nop

// f12 = 1 / f8 in double precision, as in newton.s. The constant 2 is not read from the parameter block, which may
// still be empty.
        .macro  reciprocal
        orh     0x4000, r0, r8              // 2.0
        ixfr    r0, f10
        ixfr    r8, f11
        frcp.dd f8, f12
        .rept   3
        fmul.dd f8, f12, f14
        fsub.dd f10, f14, f14
        fmul.dd f12, f14, f12
        .endr
        .endm

// ---- PRODUCT = the matrix at r5 times the vector at VECTOR
times:  mov     r5, r8
        adds    PRODUCT, r2, r9
        mov     4, r10
        fld.d   VECTOR(r2), f20
        fld.d   VECTOR+8(r2), f22
        fld.d   VECTOR+16(r2), f24
        fld.d   VECTOR+24(r2), f26
row:    fld.l   0(r8), f8
        fld.l   16(r8), f9
        fmov.sd f8, f12
        fld.l   32(r8), f10
        fmov.sd f9, f14
        fld.l   48(r8), f11
        fmul.dd f12, f20, f12
        fmov.sd f10, f16
        fmul.dd f14, f22, f14
        fmov.sd f11, f18
        fmul.dd f16, f24, f16
        fadd.dd f12, f14, f12
        fmul.dd f18, f26, f18
        adds    4, r8, r8
        fadd.dd f12, f16, f12
        adds    -1, r10, r10
        fadd.dd f12, f18, f12
        fst.d   f12, 0(r9)
        adds    8, r9, r9
        btne    r0, r10, row
        bri     r1
        nop

// VECTOR = a column of four singles at r6.
        .macro  widened k
        fld.l   4*\k(r6), f8
        fmov.sd f8, f10
        fst.d   f10, VECTOR+8*\k(r2)
        .endm

// Rounds the double at `from` of the frame, and stores the single at `to`.
        .macro  narrowed from, to
        fld.d   \from(r2), f8
        fmov.ds f8, f10
        fst.l   f10, \to
        .endm

// one coordinate of a cross product: a b - c d of the model-view matrix
        .macro  minor a, b, c, d, to
        fld.l   EYE+\a(r2), f8
        fld.l   EYE+\b(r2), f9
        fmul.sd f8, f9, f12
        fld.l   EYE+\c(r2), f8
        fld.l   EYE+\d(r2), f9
        fmul.sd f8, f9, f14
        fsub.dd f12, f14, f12
        fst.d   f12, \to(r2)
        .endm

// cross product of columns p and q
        .macro  crossed p, q, to
        minor   \p+4, \q+8, \p+8, \q+4, \to
        minor   \p+8, \q, \p, \q+8, \to+8
        minor   \p, \q+4, \p+4, \q, \to+16
        .endm

// f12 = dot product of doubles at `a` of the frame and singles at `b` of the frame, single after single
        .macro  dotted a, b
        fld.l   \b(r2), f8
        fld.d   \a(r2), f10
        fmov.sd f8, f12
        fmul.dd f12, f10, f12
        fld.l   \b+4(r2), f8
        fld.d   \a+8(r2), f10
        fmov.sd f8, f14
        fmul.dd f14, f10, f14
        fadd.dd f12, f14, f12
        fld.l   \b+8(r2), f8
        fld.d   \a+16(r2), f10
        fmov.sd f8, f14
        fmul.dd f14, f10, f14
        fadd.dd f12, f14, f12
        .endm

// Coordinate k of the eye's position.
        .macro  solved k
        dotted  CROSS+24*\k, EYE+48
        fsub.dd f0, f12, f12
        fmul.dd f12, f28, f12
        fmov.ds f12, f8
        fst.l   f8, P_ORIGIN+4*\k(r20)
        fmov.sd f8, f10
        fst.d   f10, ORIGIN+8*\k(r2)
        .endm

// f12 = a b + c d + e f of doubles in the frame, in this order
        .macro  three a, b, c, d, e, f
        fld.d   \a(r2), f8
        fld.d   \b(r2), f10
        fmul.dd f8, f10, f12
        fld.d   \c(r2), f8
        fld.d   \d(r2), f10
        fmul.dd f8, f10, f14
        fadd.dd f12, f14, f12
        fld.d   \e(r2), f8
        fld.d   \f(r2), f10
        fmul.dd f8, f10, f14
        fadd.dd f12, f14, f12
        .endm

// f16 = the greater of f16 and the squared length of row k to the eye.
        .macro  longer k
        three   ROWS+8*\k, ROWS+8*\k, ROWS+32+8*\k, ROWS+32+8*\k, ROWS+64+8*\k, ROWS+64+8*\k
        pfgt.dd f12, f16, f0
        bnc     shorter\@
        fmov.dd f12, f16
shorter\@:
        .endm

        .align  32
place:  adds    -FRAME, r2, r2
        st.l    r1, SAVE(r2)
        // model-view matrix
        mov     r16, r5
        mov     r17, r6
        adds    EYE, r2, r7
        mov     4, r4
column: widened 0
        widened 1
        widened 2
        widened 3
        call    times
        nop
        narrowed PRODUCT, 0(r7)
        narrowed PRODUCT+8, 4(r7)
        narrowed PRODUCT+16, 8(r7)
        narrowed PRODUCT+24, 12(r7)
        adds    16, r6, r6
        adds    -1, r4, r4
        adds    16, r7, r7
        btne    r0, r4, column
        // The position of the eye: the matrix maps this point to the origin.
        crossed 16, 32, CROSS
        crossed 32, 0, CROSS+24
        crossed 0, 16, CROSS+48
        dotted  CROSS, EYE
        fmov.dd f12, f8
        reciprocal
        fmov.dd f12, f28
        solved  0
        solved  1
        solved  2
        // Transform the axes and the position of the eye to eye coordinates, and then to the picture.
        mov     r0, r4
axis:   fst.d   f0, VECTOR(r2)
        fst.d   f0, VECTOR+8(r2)
        fst.d   f0, VECTOR+16(r2)
        fst.d   f0, VECTOR+24(r2)
        shl     3, r4, r7
        adds    r2, r7, r7
        orh     0x3FF0, r0, r8              // 1.0
        st.l    r8, VECTOR+4(r7)
        mov     3, r8
        btne    r8, r4, along
.if !SINGLE
        fld.d   ORIGIN(r2), f8
        fst.d   f8, VECTOR(r2)
        fld.d   ORIGIN+8(r2), f8
        fst.d   f8, VECTOR+8(r2)
        fld.d   ORIGIN+16(r2), f8
        fst.d   f8, VECTOR+16(r2)
.endif
along:  call    times
        adds    EYE, r2, r5
        fld.d   PRODUCT(r2), f8
        fld.d   PRODUCT+8(r2), f10
        fld.d   PRODUCT+16(r2), f12
        fld.d   PRODUCT+24(r2), f14
        fst.d   f8, VECTOR(r2)
        fst.d   f10, VECTOR+8(r2)
        fst.d   f12, VECTOR+16(r2)
        fst.d   f14, VECTOR+24(r2)
        shl     5, r4, r7
        mov     3, r8
        bte     r8, r4, onward
        adds    r2, r7, r7
        fmov.ds f8, f16
        fmov.sd f16, f18
        fst.d   f18, ROWS(r7)
        fmov.ds f10, f16
        fmov.sd f16, f18
        fst.d   f18, ROWS+8(r7)
        fmov.ds f12, f16
        fmov.sd f16, f18
        fst.d   f18, ROWS+16(r7)
onward: call    times
        mov     r18, r5
        shl     2, r4, r7
        adds    r20, r7, r7
        narrowed PRODUCT, P_ROWS(r7)
        narrowed PRODUCT+8, P_ROWS+16(r7)
        narrowed PRODUCT+16, P_ROWS+32(r7)
        narrowed PRODUCT+24, P_ROWS+48(r7)
        adds    1, r4, r4
        btne    4, r4, axis
        // Normals: divide the rows to the eye by the length of the longest row.
        fmov.dd f0, f16
        longer  0
        longer  1
        longer  2
        orh     0x3FE0, r0, r8              // 0.5
        ixfr    r0, f20
        ixfr    r8, f21
        orh     0x3FF8, r0, r8              // 1.5
        ixfr    r0, f22
        ixfr    r8, f23
        reciprocal_root
        orh     0x4680, r0, r8              // 2^14
        ixfr    r8, f9
        mov     r0, r4
        // Each row replaces its old value; the light gets unit length.
unit:   shl     3, r4, r7
        adds    r2, r7, r7
        shl     4, r4, r9
        adds    r20, r9, r9
        mov     3, r10
cell:   fld.d   ROWS(r7), f12
        adds    -1, r10, r10
        fmul.dd f12, f18, f12
        fmov.ds f12, f10
        fmov.sd f10, f12
        fmul.ss f10, f9, f10
        fst.d   f12, ROWS(r7)
        fst.l   f10, P_EYE(r9)
        adds    32, r7, r7
        adds    4, r9, r9
        btne    r0, r10, cell
        adds    1, r4, r4
        btne    3, r4, unit
        // Transform the light to the eye, and from there to the coordinates of the normals.
        fld.l   0(r19), f20
        fld.l   4(r19), f21
        fld.l   8(r19), f22
        mov     r16, r7
        adds    VECTOR, r2, r9
        mov     3, r4
turn:   fld.l   0(r7), f8
        fld.l   16(r7), f9
        fmul.ss f8, f20, f8
        fld.l   32(r7), f10
        fmul.ss f9, f21, f9
        fadd.ss f8, f9, f8
        fmul.ss f10, f22, f10
        adds    4, r7, r7
        fadd.ss f8, f10, f8
        fmov.sd f8, f10
        fst.d   f10, 0(r9)
        adds    8, r9, r9
        adds    -1, r4, r4
        btne    r0, r4, turn
        three   ROWS, VECTOR, ROWS+8, VECTOR+8, ROWS+16, VECTOR+16
        fmov.ds f12, f8
        fst.l   f8, P_LIGHT(r20)
        three   ROWS+32, VECTOR, ROWS+40, VECTOR+8, ROWS+48, VECTOR+16
        fmov.ds f12, f8
        fst.l   f8, P_LIGHT+4(r20)
        three   ROWS+64, VECTOR, ROWS+72, VECTOR+8, ROWS+80, VECTOR+16
        fmov.ds f12, f8
        fst.l   f8, P_LIGHT+8(r20)
        ld.l    12(r19), r8
        ld.l    16(r19), r9
        st.l    r8, P_AMBIENT(r20)
        st.l    r9, P_DIFFUSE(r20)
        // The orientation of triangles that are not drawn is the sign of the determinant of the rows x, y and w.
        st.l    r0, P_CULL(r20)
        st.l    r0, P_CULL+4(r20)
        bte     r0, r21, placed
        orh     0x8000, r0, r9
        st.l    r9, P_CULL+4(r20)
        call    sign
        adds    P_ROWS+48, r20, r7
        btne    r0, r11, signed
        call    sign                        // rows x, y and depth for a parallel projection
        adds    P_ROWS+32, r20, r7
signed: subs    r0, r11, r0
        bc      placed                      // mirrored: the determinant is greater than 0
        st.l    r9, P_CULL(r20)
placed: bte     r0, r22, left
        call    lens
        nop
left:   ld.l    SAVE(r2), r1
.if SINGLE
        st.l    r0, P_ORIGIN(r20)           // triangles are not relative to the eye
        st.l    r0, P_ORIGIN+4(r20)
        st.l    r0, P_ORIGIN+8(r20)
.endif
        nop
        bri     r1
        adds    FRAME, r2, r2

// ---- writes the words that depend on the view to the parameter block of spheres at r22. The direction towards the
// light in eye coordinates is at VECTOR.

// Row k of the matrix to the eye, without its last number.
        .macro  eyerow k
        ld.l    EYE+4*\k(r2), r8
        ld.l    EYE+16+4*\k(r2), r9
        ld.l    EYE+32+4*\k(r2), r10
        st.l    r8, S_ROWS+16*\k(r22)
        st.l    r9, S_ROWS+16*\k+4(r22)
        st.l    r10, S_ROWS+16*\k+8(r22)
        ld.l    P_ORIGIN+4*\k(r20), r8
        fld.d   VECTOR+8*\k(r2), f8
        st.l    r8, S_ORIGIN+4*\k(r22)
        fst.d   f8, S_LIGHT+8*\k(r22)
        fld.d   ORIGIN+8*\k(r2), f8
        fst.d   f8, VECTOR+8*\k(r2)
        .endm

// f16 = the greater of f16 and the squared length of axis k of the matrix to the eye.
        .macro  wider k
        fld.l   EYE+16*\k(r2), f8
        fld.l   EYE+16*\k+4(r2), f9
        fmul.sd f8, f8, f12
        fld.l   EYE+16*\k+8(r2), f10
        fmul.sd f9, f9, f14
        fadd.dd f12, f14, f12
        fmul.sd f10, f10, f14
        fadd.dd f12, f14, f12
        pfgt.dd f12, f16, f0
        bnc     thinner\@
        fmov.dd f12, f16
thinner\@:
        .endm

// Words for axis k of the picture. In: the projection's scale at `scale`, the shift of the middle at `shift`.
        .macro  across k, scale, shift
        fld.l   \scale(r18), f8
        fld.d   S_HALF_FRAME+8*\k(r22), f10
        fmov.sd f8, f16
        fmul.dd f16, f10, f12
        fst.d   f12, S_RATE+8*\k(r22)
        fmov.dd f16, f8
        reciprocal
        fld.d   S_PER_HALF+8*\k(r22), f8
        fld.d   S_FIRST+8*\k(r22), f10
        fmul.dd f12, f8, f8
        fst.d   f8, S_STEP+8*\k(r22)
        fadd.dd f10, \shift, f10
        fmul.dd f10, f12, f10
        fst.d   f10, S_CORNER+8*\k(r22)
        .endm

// A number of the projection as a double.
        .macro  celled at, to
        fld.l   \at(r18), f8
        fmov.sd f8, \to
        .endm

lens:   st.l    r1, LINK(r2)
        eyerow  0
        eyerow  1
        eyerow  2
        orh     0x3FF0, r0, r8              // 1.0
        st.l    r0, VECTOR+24(r2)
        st.l    r8, VECTOR+28(r2)
        call    times
        adds    EYE, r2, r5
        narrowed PRODUCT, S_ROWS+12(r22)
        narrowed PRODUCT+8, S_ROWS+28(r22)
        narrowed PRODUCT+16, S_ROWS+44(r22)
        fld.l   12(r19), f8
        fld.l   16(r19), f9
        fmov.sd f8, f10
        fmov.sd f9, f12
        fst.d   f10, S_AMBIENT(r22)
        fst.d   f12, S_DIFFUSE(r22)
        fmov.dd f0, f16
        wider   0
        wider   1
        wider   2
        fld.d   S_HALF(r22), f20
        fld.d   S_THREE_HALVES(r22), f22
        nop
        reciprocal_root
        fmul.dd f16, f18, f16
        fst.d   f16, S_SCALE(r22)
        // The projection is parallel if w does not depend on z.
        ld.l    44(r18), r8
        fld.d   S_ONE(r22), f30
        andnoth 0x8000, r8, r8
        bte     r0, r8, parallel
        st.l    r0, S_PARALLEL(r22)
        celled  32, f2                      // shift along x and y
        celled  36, f4
        celled  56, f6                      // slope of depth
        celled  40, f18
        fsub.dd f0, f18, f18                // constant part of the depth
        fst.d   f18, S_NEAR(r22)
        fst.d   f6, S_NEAR+8(r22)
        fsub.dd f18, f30, f8
        fst.d   f8, S_FAR(r22)
        fst.d   f6, S_FAR+8(r22)
        br      deep
        fst.d   f0, S_LEAST(r22)
parallel: mov   1, r8
        st.l    r8, S_PARALLEL(r22)
        celled  48, f2
        celled  52, f4
        fsub.dd f0, f2, f2
        fsub.dd f0, f4, f4
        celled  40, f6
        celled  56, f18
        fsub.dd f0, f6, f8
        fst.d   f8, S_NEAR(r22)
        fst.d   f18, S_NEAR+8(r22)
        fst.d   f8, S_FAR(r22)
        fsub.dd f18, f30, f8
        fst.d   f8, S_FAR+8(r22)
        fld.d   S_PARALLEL_LEAST(r22), f8
        fst.d   f8, S_LEAST(r22)
deep:   fld.d   S_RANGE(r22), f8
        fld.d   S_DEPTH_NEAR(r22), f10
        fmul.dd f8, f18, f18
        fmul.dd f8, f6, f6
        fadd.dd f10, f18, f18
        fst.d   f18, S_BASE(r22)
        fst.d   f6, S_REACH(r22)
        across  0, 0, f2
        across  1, 20, f4
        ld.l    LINK(r2), r1
        nop
        bri     r1
        nop

// ---- r11 = sign of the determinant of the rows x, y and the row at r7: less than, equal to or greater than 0
        .macro  part a, b, c
        fld.l   P_ROWS+\a(r20), f8
        fld.l   P_ROWS+16+\b(r20), f9
        fmul.sd f8, f9, f12
        fld.l   P_ROWS+\b(r20), f8
        fld.l   P_ROWS+16+\a(r20), f9
        fmul.sd f8, f9, f14
        fsub.dd f12, f14, f12
        fld.l   \c(r7), f8
        fmov.sd f8, f14
        fmul.dd f12, f14, f12
        fadd.dd f16, f12, f16
        .endm

sign:   fmov.dd f0, f16
        part    4, 8, 0
        part    8, 0, 4
        part    0, 4, 8
        mov     r0, r11
        pfgt.dd f0, f16, f0
        bnc     notless
        mov     -1, r11
notless: pfgt.dd f16, f0, f0
        bnc     notgreater
        mov     1, r11
notgreater: bri r1
        nop
