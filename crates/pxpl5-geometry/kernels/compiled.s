// The kernel of compiled code (Schedule::Compiled, compiled_rules.md), and the code for triangles between two views.

.if PHONG
// Normals at the corners of the compiled kernel.

// r8 = address for P_SIDES, or 24 bytes more if the normals of the three corners together turn away from the eye.
        .macro  surfaces
        sided   CORNERS+C_AWAY, C_BYTES
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
normals: call   normal
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, normals
        .endm

// ---- normal: stores the normal of the vertex at r5 in the structure at r6, and advances r6 to the next structure. r8
// selects the side.
normal: fld.l   NORMAL(r5), f20
        fld.l   NORMAL+4(r5), f21
        fld.l   NORMAL+8(r5), f22
        adds    C_SURFACE, r6, r10
        mov     r20, r11
        mov     3, r9
        fld.l   P_SIDES+8(r8), f10
        fld.d   P_SIDES+16(r8), f12
        fld.l   P_ROUND_S(r20), f9
axis:   alongaxis
        fadd.ss f16, f9, f16
        fmul.sd f16, f10, f18
        fadd.dd f18, f12, f18
        fst.d   f18, 0(r10)
        adds    8, r10, r10
        btne    r0, r9, axis
        adds    C_BYTES, r6, r6
        bri     r1
        nop
.elseif PRECOMPUTED
// The precomputed colours at the corners of the compiled kernel.

        .macro  surfaces
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
colours: call   colour
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, colours
        .endm

// ---- colour: stores the colour of the vertex at r5 in the structure at r6, and advances r6 to the next structure
colour: ld.l    COLOUR(r5), r8
        mov     16, r9
        mov     -8, r7
        adds    C_SURFACE, r6, r10
        orh     0x4330, r0, r11             // high word of 2^52
        ixfr    r11, f17
        fld.d   P_SURFACE(r20), f12
component: shr  r9, r8, r11                 // 8 bits of the colour in units of 1/4096, plus half a unit
        and     255, r11, r11
        shl     12, r11, r11
        or      2048, r11, r11
        ixfr    r11, f16
        adds    -8, r9, r9
        nop
        fsub.dd f16, f12, f18
        fst.d   f18, 0(r10)
        adds    8, r10, r10
        btne    r9, r7, component           // r7 is the shift after the last component
        adds    C_BYTES, r6, r6
        bri     r1
        nop
.else
// The light at the corners of the compiled kernel.

        .macro  surfaces
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
lights: call    light
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, lights
        .endm

// ---- light: stores the lit colour of the vertex at r5 in the structure at r6, and advances r6 to the next structure
light:  intensity C_AWAY
        mov     16, r9
        mov     -8, r7
        adds    C_SURFACE, r6, r10
        fld.l   P_TWO23(r20), f8
        fld.l   P_ROUND_S(r20), f9
        fld.l   P_SIDES+8(r20), f10
        fld.d   P_SIDES+16(r20), f12
component: shr  r9, r8, r11                 // 256 times 8 bits of the colour, by an addition to 2^23
        and     255, r11, r11
        shl     8, r11, r11
        orh     0x4B00, r11, r11
        ixfr    r11, f17
        adds    -8, r9, r9
        nop
        fsub.ss f17, f8, f17
        fmul.ss f17, f16, f17
        fadd.ss f17, f9, f17
        fmul.sd f17, f10, f18
        fadd.dd f18, f12, f18
        fst.d   f18, 0(r10)
        adds    8, r10, r10
        btne    r9, r7, component           // r7 is the shift after the last component
        adds    C_BYTES, r6, r6
        bri     r1
        nop
.endif

// Computes one triangle after another, like the output of a good compiler of about 1990 for a plain program in C: with
// calls of functions, with loops, with local variables in registers, and with scalar floating point with loads in its
// shadow. The rules were written before the code (compiled_rules.md).
//
// The arithmetic and its order are the same as in the native transform and set-up.

// ---- stack frame; the upper part is as in scalar.s
SAVE   = 0        // return address

        .macro  secondcorner to
        adds    C_BYTES, r7, \to
        .endm

// Planes of triangles that are not clipped are not tested for steep slopes.
        .macro  steep
        .endm

// The corners of a triangle are computed for one eye.

        .macro  firstcorner to
        adds    CORNERS, r2, \to
        .endm
        .macro  surfaceof k
        adds    C_SURFACE+8*\k, r0, r10
        .endm

.if BETWEEN
// Triangles between two views: makes the commands of a strip, and keeps them with their boxes (kernels/between_rules.md
// of pphigs).
//
// In: registers as for a kernel that keeps boxes. In addition: r21 records of the triangles, r22 and r23 least and
// greatest y near the strip in 1/16 px of the frame, r24 not 0 if triangles are interpolated in the view, r25 and r26
// fraction of the way between the views as a double.

// ---- stack frame, after the corners
NEAR_TOP = 240
NEAR_BOTTOM = 244
PART    = 248
IN_VIEW = 256

        .align  32
start:  st.l    r1, SAVE(r2)
        st.l    r22, NEAR_TOP(r2)
        st.l    r23, NEAR_BOTTOM(r2)
        st.l    r24, IN_VIEW(r2)
        st.l    r25, PART(r2)
        st.l    r26, PART+4(r2)
next:   ld.l    E_INSIDE(r21), r5
        ld.l    E_TOP(r21), r6
        mov     3, r4
        bte     r0, r5, whole               // not on the screen in both views
        ld.l    NEAR_BOTTOM(r2), r7
        ld.l    E_BOTTOM(r21), r8
        subs    r7, r6, r0
        bc      done                        // below the strip
        ld.l    NEAR_TOP(r2), r7
        ld.l    IN_VIEW(r2), r5
        subs    r8, r7, r0
        bc      done                        // above the strip
        btne    r0, r5, whole
        mov     r16, r5
        adds    CORNERS, r2, r6
        adds    E_CORNERS, r21, r10
screen: call    between
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, screen
        br      lit
        nop
whole:  mov     r16, r5
        adds    CORNERS, r2, r6
each:   call    corner
        adds    -1, r4, r4
        bte     r0, r7, clip
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, each
lit:    surfaces
        set_up  done
done:   adds    -1, r17, r17
        adds    LIST_STEP, r16, r16
        adds    E_BYTES, r21, r21
        nextorclip

// f18 = the integer nearest to f12 + f30 (f14 - f12), rounded up between two integers. In: 1.5 * 2^52 in f26, 1/2 in
// f28.
        .macro  nearest
        fsub.dd f14, f12, f14
        fmul.dd f14, f30, f14
        fadd.dd f12, f14, f12
        fadd.dd f12, f28, f12
        fadd.dd f12, f26, f18
        fsub.dd f18, f26, f18
        pfgt.dd f18, f12, f0
        bnc     floor\@
        fsub.dd f18, f28, f18
        fsub.dd f18, f28, f18
floor\@:
        .endm

// Interpolates coordinate `at` of the corner at r10, and stores it at `to` of the structure at r6.
        .macro  coordinate at, to
        fld.l   \at(r10), f8
        fld.l   E_VIEW+\at(r10), f9
        fmov.sd f8, f12
        fmov.sd f9, f14
        nearest
        fmov.ds f18, f8
        fst.l   f8, \to(r6)
        .endm

// ---- between: stores the vertex at r5 and its positions at r10 in the structure at r6, and advances r6 and r10
between: fld.l  0(r5), f16
        fld.l   P_ORIGIN(r20), f8
        fld.l   4(r5), f17
        fld.l   P_ORIGIN+4(r20), f9
        fsub.ss f16, f8, f16
        fld.l   8(r5), f18
        fld.l   P_ORIGIN+8(r20), f10
        fsub.ss f17, f9, f17
        fld.l   NORMAL(r5), f20
        fsub.ss f18, f10, f18
        fld.l   NORMAL+4(r5), f21
        fmul.ss f16, f20, f16               // how far the normal turns away
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fld.d   P_ROUND(r20), f26
        fmul.ss f18, f22, f18
        fld.d   P_HALF(r20), f28
        fadd.ss f16, f18, f16
        fld.d   PART(r2), f30
        fst.l   f16, C_AWAY(r6)
        coordinate 0, C_X
        coordinate 4, C_Y
        fld.d   E_DEPTH(r10), f12
        fld.d   E_VIEW+E_DEPTH(r10), f14
        nearest
        orh     0x41EF, r0, r7              // 2^32 - 1
        or      0xFFFF, r7, r7
        ixfr    r7, f21
        orh     0xFFE0, r0, r7
        ixfr    r7, f20
        pfgt.dd f18, f0, f0
        bc      above
        fmov.dd f0, f18
above:  pfgt.dd f18, f20, f0
        bnc     below
        fmov.dd f20, f18
below:  fst.d   f18, C_DEPTH(r6)
        adds    E_CORNER, r10, r10
        bri     r1
        adds    C_BYTES, r6, r6
.else
// The main loop.

        .align  32
start:  st.l    r1, SAVE(r2)
        counted
next:   passover_straight
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
each:   call    corner
        adds    -1, r4, r4
        bte     r0, r7, clip
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, each
        surfaces
        set_up  done
done:   adds    -1, r17, r17
        adds    LIST_STEP, r16, r16
        nextorclip
.endif

.if PRECOMPUTED & !BETWEEN
// ---- corner: stores the vertex at r5 in the structure at r6, without a normal, and advances r6. r7 is 0 if the vertex
// is outside the guard band.

corner: projected
        guarded
        placed
        fsub.dd f12, f10, f12
        fst.d   f12, C_DEPTH(r6)
        adds    C_BYTES, r6, r6
        bri     r1
        mov     1, r7
beyond: bri    r1
        mov     r0, r7
.else
// ---- corner: stores the vertex at r5 in the structure at r6, and advances r6. r7 is 0 if the vertex is outside the
// guard band.

corner: projected
        guarded
        placed
        fld.l   NORMAL(r5), f20
        fsub.dd f12, f10, f12
        fld.l   NORMAL+4(r5), f21
        fst.d   f12, C_DEPTH(r6)
        fmul.ss f16, f20, f16               // how far the normal turns away
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        fadd.ss f16, f18, f16
        fst.l   f16, C_AWAY(r6)
        adds    C_BYTES, r6, r6
        bri     r1
        mov     1, r7
beyond: bri    r1
        mov     r0, r7
.endif
