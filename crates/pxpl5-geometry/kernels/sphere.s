.if BOXES
// There are no bins of spheres. The box of each command is stored at r19, in pixels of the picture.

        .macro  boxed
        st.l    r11, 0(r19)
        st.l    r12, 4(r19)
        st.l    r13, 8(r19)
        st.l    r14, 12(r19)
        adds    16, r19, r19
        .endm

        .macro  binned
        .endm
.else
// Spheres go into the bins of the regions that their boxes meet.

        .macro  boxed
        .endm

// Columns r11 to r12 and rows r13 to r14 of regions.
        .macro  binned
        mov     r0, r22
        mov     r13, r15
rows:   mov     r11, r23
columns: regionnumber r15, r23
        insert  r28
        adds    1, r23, r23
        subs    r12, r23, r0
        bnc     columns
        adds    1, r15, r15
        subs    r14, r15, r0
        bnc     rows
        .endm
.endif

.if PHONG
// A command: enable; silhouette, root, depth; normal x and y; normal z from the root; the object's colour.
COMMAND_BYTES = 152

        .macro  surface
        fld.d   PEAK_VALUE(r2), f16         // the root at the middle of the sphere; z is a quarter of it
        call    root
        nop
        fmul.dd f16, f18, f18
        mov     1023, r8
        subs    r8, r25, r8
        shl     20, r8, r8
        ixfr    r0, f8
        ixfr    r8, f9
        fmul.dd f18, f8, f18                // 2^-depth_shift
        fld.d   S_QUARTER(r20), f8
        fld.d   S_UNIT(r20), f10
        fmul.dd f18, f8, f18
        fmul.dd f18, f10, f18
        fst.d   f18, UP(r2)
        fld.d   PER(r2), f8
        fld.d   S_HALF_UNIT(r20), f16
        fmul.dd f18, f8, f18
        fmov.dd f0, f20
        fld.d   PEAK(r2), f22
        fld.d   PEAK+8(r2), f24
        call    plane
        adds    108, r18, r11
        fld.d   UP(r2), f18
        fld.d   PER+8(r2), f8
        fsub.dd f0, f18, f18
        fld.d   S_HALF_UNIT(r20), f16
        fmul.dd f18, f8, f20
        fmov.dd f0, f18
        call    plane
        adds    124, r18, r11
        restated 108
        restated 124
        heads   26, 30
        heads   34, 35
        ld.l    S_WORDS+144(r20), r8
        ld.l    COLOUR(r16), r9
        st.l    r8, 144(r18)
        st.l    r9, 148(r18)
        .endm
.else
// A command: enable; silhouette, root, depth; for each of three components a product with the root, a linear part, a
// limit.
COMMAND_BYTES = 212

// Reverses the vector f24 f26 f28.
        .macro  turnedround
        fsub.dd f0, f24, f24
        fsub.dd f0, f26, f26
        fsub.dd f0, f28, f28
        .endm

// Scales the vector f24 f26 f28 to length 1.
        .macro  unit
        fmul.dd f24, f24, f16
        fmul.dd f26, f26, f8
        fadd.dd f16, f8, f16
        fmul.dd f28, f28, f8
        call    root
        fadd.dd f16, f8, f16
        fmul.dd f24, f18, f24
        fmul.dd f26, f18, f26
        fmul.dd f28, f18, f28
        .endm

// Takes the unit vector along axis k, removes its part along the direction to the eye, and scales the result to length
// 1. Stores the part of this vector along the light.
        .macro  across k, to
        fld.d   TOWARDS(r2), f24
        fld.d   TOWARDS+8(r2), f26
        fld.d   TOWARDS+16(r2), f28
        fld.d   TOWARDS+8*\k(r2), f30
        fmul.dd f30, f24, f24
        fmul.dd f30, f26, f26
        fmul.dd f30, f28, f28
        turnedround
        fld.d   S_ONE(r20), f8
        oneof\k
        unit
        lit     f24, f26, f28
        fst.d   f24, \to(r2)
        .endm
        .macro  oneof0
        fadd.dd f24, f8, f24
        .endm
        .macro  oneof1
        fadd.dd f26, f8, f26
        .endm

// a = dot product of the vector a, b, c and the light.
        .macro  lit a, b, c
        fld.d   S_LIGHT(r20), f8
        fld.d   S_LIGHT+8(r20), f10
        fmul.dd \a, f8, \a
        fmul.dd \b, f10, \b
        fadd.dd \a, \b, \a
        fld.d   S_LIGHT+16(r20), f8
        fmul.dd \c, f8, \c
        fadd.dd \a, \c, \a
        .endm

        .macro  surface
        // Direction towards the eye.
        ld.l    S_PARALLEL(r20), r8
        fmov.dd f0, f24
        fmov.dd f0, f26
        fld.d   S_ONE(r20), f28
        btne    r0, r8, ahead
        fld.d   CENTRE(r2), f24
        fld.d   CENTRE+8(r2), f26
        fld.d   CENTRE+16(r2), f28
        turnedround
        unit
ahead:  fst.d   f24, TOWARDS(r2)
        fst.d   f26, TOWARDS+8(r2)
        fst.d   f28, TOWARDS+16(r2)
        across  0, ACROSS
        across  1, UP
        fld.d   TOWARDS(r2), f24
        fld.d   TOWARDS+8(r2), f26
        fld.d   TOWARDS+16(r2), f28
        lit     f24, f26, f28
        fst.d   f24, TOWARDS(r2)
        // Reciprocal of the greatest value of the root's upper bits.
        fld.d   PEAK_VALUE(r2), f16
        call    root
        nop
        adds    1027, r25, r8
        shl     20, r8, r8
        ixfr    r0, f8
        ixfr    r8, f9
        fmul.dd f18, f8, f18                // 16 times 2^depth_shift
        fst.d   f18, PER_ROOT(r2)
        orh     0x4330, r0, r30
        adds    112, r18, r10
        adds    COLOUR+2, r16, r9           // red
        mov     3, r4
component: ld.b 0(r9), r8
        fld.d   S_TWO52(r20), f10
        and     255, r8, r8
        ixfr    r8, f28
        ixfr    r30, f29
        fsub.dd f28, f10, f28               // the component
        fld.d   S_DIFFUSE(r20), f30
        fmul.dd f28, f30, f12               // part of the root
        fld.d   TOWARDS(r2), f8
        fmul.dd f12, f8, f12
        fld.d   S_256(r20), f8
        fmul.dd f12, f8, f12
        fld.d   PER_ROOT(r2), f8
        fmul.dd f12, f8, f12
        fld.d   S_511(r20), f14
        pfgt.dd f12, f0, f0
        bc      lighter
        fmov.dd f0, f12
lighter: pfgt.dd f14, f12, f0
        bc      darker
        fmov.dd f14, f12
darker: fld.d   S_ROUND(r20), f10
        fld.d   S_UNIT(r20), f26
        fadd.dd f12, f10, f12
        fmul.dd f28, f26, f28
        fxfr    f12, r8
        fld.d   S_AMBIENT(r20), f8
        fmul.dd f28, f8, f16
        fld.d   S_HALF_UNIT(r20), f10
        fmul.dd f28, f30, f28
        st.l    r8, 0(r10)
        fadd.dd f16, f10, f16
        fld.d   ACROSS(r2), f8
        fmul.dd f28, f8, f18
        fld.d   PER(r2), f10
        fmul.dd f18, f10, f18
        fld.d   UP(r2), f8
        fmul.dd f28, f8, f20
        fld.d   PER+8(r2), f10
        fsub.dd f0, f20, f20
        fmul.dd f20, f10, f20
        fld.d   PEAK(r2), f22
        fld.d   PEAK+8(r2), f24
        call    plane
        adds    8, r10, r11
        adds    -1, r9, r9
        adds    -1, r4, r4
        adds    36, r10, r10
        btne    r0, r4, component
        restated 120
        restated 156
        restated 192
        heads   26, 27
        heads   29, 33
        heads   34, 35
        heads   36, 38
        heads   42, 43
        heads   44, 45
        heads   47, 51
        ld.l    S_WORDS+208(r20), r8
        nop
        st.l    r8, 208(r18)
        .endm
.endif

// Macros for spheres: tests, ranges of pixels, integers of 64 bits. The registers and the stack frame are described
// below.

// Jumps to `drop` unless |v| <= f12.
        .macro  limited v
        pfle.dd \v, f12, f0
        bc      drop
        fsub.dd f0, \v, f14
        pfle.dd f14, f12, f0
        bc      drop
        .endm

// Jumps to `drop` if the number with this high word is NaN or infinite.
        .macro  finite high
        fxfr    \high, r8
        andh    0x7FF0, r8, r8
        xorh    0x7FF0, r8, r8
        bc      drop
        .endm

// Eye coordinate k of the point in f16 f17 f18.
        .macro  eye k, to
        fld.l   S_ROWS+16*\k(r20), f8
        fld.l   S_ROWS+16*\k+4(r20), f9
        fmul.ss f8, f16, \to
        fld.l   S_ROWS+16*\k+8(r20), f10
        fmul.ss f9, f17, f12
        fld.l   S_ROWS+16*\k+12(r20), f11
        fadd.ss \to, f12, \to
        fmul.ss f10, f18, f12
        fadd.ss \to, f12, \to
        fadd.ss \to, f11, \to
        .endm

// Pixel coordinate k of an eye coordinate.
        .macro  pixel k, from
        fld.d   S_CORNER+8*\k(r20), f8
        fld.d   S_RATE+8*\k(r20), f10
        fsub.dd \from, f8, f8
        fmul.dd f8, f10, f8
        fst.d   f8, ORIGIN+8*\k(r2)
        .endm

// Multiplies a coefficient in f8 by the square of the bulge.
        .macro  scaled to
        fmul.dd f8, f18, f8
        fst.d   f8, \to(r2)
        .endm

// First and last pixel of the ellipse along axis k.
        .macro  extent k, first, last
        fld.d   SQUARES+8*\k(r2), f16
        call    root
        nop
        fst.d   f18, PER+8*\k(r2)
        fmul.dd f16, f18, f18
        fld.d   PEAK+8*\k(r2), f10
        fsub.dd f10, f18, f12
        fadd.dd f10, f18, f14
        finite  f13
        finite  f15
        fld.d   S_SLACK(r20), f16
        fld.d   S_MOST_PIXEL(r20), f18
        fsub.dd f12, f16, f12
        fadd.dd f14, f16, f14
        fsub.dd f0, f18, f20
        within  f12
        within  f14
        fld.d   S_ROUND(r20), f16
        fadd.dd f12, f16, f18               // round up
        fxfr    f18, \first
        fsub.dd f18, f16, f18
        pfgt.dd f12, f18, f0
        bnc     up\@
        adds    1, \first, \first
up\@:   fadd.dd f14, f16, f18               // round down
        fxfr    f18, \last
        fsub.dd f18, f16, f18
        pfgt.dd f18, f14, f0
        bnc     down\@
        adds    -1, \last, \last
down\@:
        .endm

// Limits v to the range from f20 to f18.
        .macro  within v
        pfgt.dd \v, f20, f0
        bc      low\@
        fmov.dd f20, \v
low\@:  pfgt.dd f18, \v, f0
        bc      high\@
        fmov.dd f18, \v
high\@:
        .endm

// Limits r to the range from 0 to `most`.
        .macro  clamped r, most
        subs    r0, \r, r0
        bc      low\@                       // r > 0
        mov     r0, \r
low\@:  subs    \most, \r, r0
        bnc     high\@
        mov     \most, \r
high\@:
        .endm

// A range that begins at 0 or later and ends at the limit of `atmost` or earlier. Jumps to `drop` if the range is
// empty.
        .macro  clipped first, last, atmost
        subs    r0, \first, r0
        bc      above\@                     // first > 0
        mov     r0, \first
above\@: \atmost \last
        subs    \last, \first, r0
        bc      drop
        .endm

// Converts an integer of at least 0 to a double. In: r30 high word of 2^52, f10 2^52.
        .macro  double r, to
        ixfr    \r, f8
        ixfr    r30, f9
        fsub.dd f8, f10, f8
        fst.d   f8, \to(r2)
        .endm

// The pixel nearest to the peak along axis k.
        .macro  nearest k, first, last, word
        fld.d   \first(r2), f20
        fld.d   \last(r2), f18
        fld.d   PEAK+8*\k(r2), f12
        within  f12
        fadd.dd f12, f16, f12
        fxfr    f12, r8
        fsub.dd f12, f16, f12
        st.l    r8, \word(r2)
        st.l    r0, \word+4(r2)
        fst.d   f12, PIXEL+8*\k(r2)
        .endm

// f30 = the greater of f30 and |value| at a corner.
        .macro  greater x, y
        fld.d   \x(r2), f8
        fld.d   ORIGIN(r2), f12
        fld.d   \y(r2), f10
        fsub.dd f8, f12, f8
        fld.d   ORIGIN+8(r2), f12
        call    value
        fsub.dd f10, f12, f10
        fsub.dd f0, f12, f14
        pfgt.dd f12, f30, f0
        bnc     less\@
        fmov.dd f12, f30
less\@: pfgt.dd f14, f30, f0
        bnc     lesser\@
        fmov.dd f14, f30
lesser\@:
        .endm

// The integer of 64 bits nearest to a times f28. In: 1.5 * 2^52 in f30.
        .macro  whole a
        fmul.dd \a, f28, \a
        fadd.dd \a, f30, \a
        fisub.dd \a, f30, \a
        .endm

// to = the number of 64 bits in low and high, times the small number p. f9, f11 and f14 must be 0.
        .macro  times low, high, p, to
        fmov.ss \low, f8
        fmov.ss \high, f10
        fmlow.dd f8, \p, \to
        fmlow.dd f10, \p, f12
        fmov.ss f12, f15
        fiadd.dd \to, f14, \to
        .endm

// words m and n of the command
        .macro  heads m, n
        ld.l    S_WORDS+4*\m(r20), r8
        ld.l    S_WORDS+4*\n(r20), r9
        st.l    r8, 4*\m(r18)
        st.l    r9, 4*\n(r18)
        .endm

// Makes the words of commands and bin entries from the spheres of the display list. The code is like the output of a
// good compiler of about 1990 for a plain program in C (compiled_rules.md). The arithmetic and its order are the same
// as in the native transform and set-up.
//
// A sphere of the display list: centre x, y, z and radius (single), colour (0x00RRGGBB), three words unused.
//
// In: r16 first sphere, r17 number of spheres (at least 1), r18 address for command words, r19 table of bins, r20
// parameter block, r2 stack. Out: r18 address after the last command.

SPHERE_BYTES = 32
RADIUS  = 12
COLOUR  = 16
P_TWO   = S_TWO
P_LINE  = S_LINE
P_LAST_X = S_LAST_X
P_LAST_Y = S_LAST_Y
P_COLUMNS = S_COLUMNS

// ---- stack frame
SAVE    = 0        // return address
CENTRE  = 16       // centre in eye coordinates, double
FRONT   = 40       // distance of the nearest point
ORIGIN  = 48       // origin of the conic, in pixels
ONE     = 64       // coefficients of the conic: constant, x, y, xx, xy, yy
ALONG_X = 72
ALONG_Y = 80
XX      = 88
XY      = 96
YY      = 104
DEPTH   = 112      // plane of depth: value, slopes
PEAK    = 136      // position of the ellipse's greatest value
PEAK_VALUE = 152
SQUARES = 160      // squares of half the width and half the height of the ellipse
PER     = 176      // reciprocals of half the width and half the height
LEFT    = 192      // frame pixels of the touched regions, double
RIGHT   = 200
TOP     = 208
BOTTOM  = 216
PIXEL   = 224      // pixel around which planes are rounded, double
PIXEL_X = 240      // the same pixel as words, with high words of 0
PIXEL_Y = 248
TOWARDS = 256      // Gouraud: direction towards the eye; its part along the light
ACROSS  = 280      // parts along the light of the unit vectors across and up (see macro `across`)
UP      = 288
PER_ROOT = 296

        .align  32
spheres: st.l   r1, SAVE(r2)
        ld.l    P_LINE(r20), r5
        nop
        subs    r0, r5, r5                  // all ones in a field that begins with line 1
next:   fld.l   0(r16), f16
        fld.l   S_ORIGIN(r20), f8
        fld.l   4(r16), f17
        fld.l   S_ORIGIN+4(r20), f9
        fsub.ss f16, f8, f16
        fld.l   8(r16), f18
        fld.l   S_ORIGIN+8(r20), f10
        fsub.ss f17, f9, f17
        fsub.ss f18, f10, f18
        eye     0, f20
        eye     1, f21
        eye     2, f22
        fmov.sd f20, f2
        fld.l   RADIUS(r16), f8
        fmov.sd f21, f4
        fld.d   S_SCALE(r20), f28
        fmov.sd f22, f6
        fmov.sd f8, f10
        fld.d   S_MOST(r20), f12
        fmul.dd f10, f28, f28               // the radius
        limited f2
        limited f4
        limited f6
        limited f28
        pfle.dd f0, f28, f0
        bc      drop
        // Is the sphere visible?
        fsub.dd f0, f6, f30                 // distance of the middle
        fld.d   S_LEAST(r20), f8
        fsub.dd f30, f28, f14               // distance of the front
        fld.d   S_NEAR(r20), f10
        fadd.dd f30, f28, f16               // distance of the back
        pfgt.dd f14, f8, f0
        bnc     drop
        fmul.dd f10, f14, f10
        fld.d   S_NEAR+8(r20), f12
        fadd.dd f10, f12, f10
        pfgt.dd f0, f10, f0
        bc      drop
        fld.d   S_FAR(r20), f20
        fmul.dd f20, f14, f10
        fld.d   S_FAR+8(r20), f22
        fadd.dd f10, f22, f10
        pfgt.dd f10, f0, f0
        bc      drop
        fst.d   f14, FRONT(r2)
        fst.d   f2, CENTRE(r2)
        fst.d   f4, CENTRE+8(r2)
        fst.d   f6, CENTRE+16(r2)
        fmul.dd f2, f2, f24                 // squares of the distance of the middle and of the radius
        fmul.dd f4, f4, f8
        fadd.dd f24, f8, f24
        fmul.dd f6, f6, f8
        fadd.dd f24, f8, f24
        fmul.dd f28, f28, f26
        fmul.dd f20, f16, f10
        ld.l    S_PARALLEL(r20), r4
        fadd.dd f10, f22, f10
        pfgt.dd f10, f0, f0
        bnc     seen
        // The deepest point of the silhouette.
        fmov.dd f30, f16
        btne    r0, r4, deepest
        fmov.dd f24, f8
        reciprocal
        fld.d   S_ONE(r20), f10
        fmul.dd f26, f12, f14
        fmul.dd f6, f6, f16
        fsub.dd f10, f14, f14               // factor by which the circle of tangents is smaller
        fmul.dd f16, f12, f16
        fsub.dd f10, f16, f16               // slope of the circle of tangents
        fmul.dd f14, f16, f16
        fmul.dd f30, f14, f30
        pfgt.dd f16, f0, f0
        bnc     straight
        call    root
        nop
        fmul.dd f16, f18, f16
        fmul.dd f28, f16, f16
        br      beside
        nop
straight: fmov.dd f0, f16
beside: fadd.dd f30, f16, f16
        fsub.dd f0, f6, f30
        fld.d   S_FAR(r20), f20
        fld.d   S_FAR+8(r20), f22
deepest: fmul.dd f20, f16, f10
        fadd.dd f10, f22, f10
        pfgt.dd f10, f0, f0
        bc      drop
        // The picture, and the plane of depth.
seen:   btne    r0, r4, parallel
        fmov.dd f30, f8
        reciprocal                          // 1 / distance
        fmul.dd f2, f12, f20
        fmul.dd f4, f12, f22
        fmul.dd f24, f12, f18
        fsub.dd f24, f26, f8
        reciprocal
        fld.d   S_REACH(r20), f8
        fld.d   S_BASE(r20), f10
        fmul.dd f8, f12, f16                // factor of the bulge
        fld.d   S_STEP(r20), f12
        fmul.dd f16, f18, f8
        fld.d   S_STEP+8(r20), f14
        fadd.dd f10, f8, f8
        fst.d   f8, DEPTH(r2)
        fmul.dd f16, f12, f8
        fmul.dd f8, f2, f8
        fst.d   f8, DEPTH+8(r2)
        fmul.dd f16, f14, f8
        fmul.dd f8, f4, f8
        fst.d   f8, DEPTH+16(r2)
        fmul.dd f16, f16, f18
        pixel   0, f20
        pixel   1, f22
        fmul.dd f20, f20, f8                // constant
        fmul.dd f22, f22, f10
        fadd.dd f8, f10, f8
        fld.d   S_ONE(r20), f10
        fadd.dd f8, f10, f8
        fmul.dd f26, f8, f8
        scaled  ONE
        fld.d   P_TWO(r20), f16
        fmul.dd f16, f26, f10               // x, y
        fmul.dd f10, f12, f8
        fmul.dd f8, f20, f8
        scaled  ALONG_X
        fmul.dd f10, f14, f8
        fmul.dd f8, f22, f8
        scaled  ALONG_Y
        fmul.dd f16, f12, f8                // xy
        fmul.dd f8, f14, f8
        fmul.dd f8, f2, f8
        fmul.dd f8, f4, f8
        scaled  XY
        fmul.dd f12, f12, f12
        fmul.dd f14, f14, f14
        fmul.dd f4, f4, f8                  // xx
        fmul.dd f6, f6, f10
        fadd.dd f8, f10, f8
        fsub.dd f26, f8, f8
        fmul.dd f12, f8, f8
        scaled  XX
        fmul.dd f2, f2, f8                  // yy
        fadd.dd f8, f10, f8
        fsub.dd f26, f8, f8
        fmul.dd f14, f8, f8
        scaled  YY
        br      pictured
        nop
parallel: fld.d S_REACH(r20), f18
        fld.d   S_BASE(r20), f10
        fmul.dd f18, f6, f8
        fst.d   f0, DEPTH+8(r2)
        fst.d   f0, DEPTH+16(r2)
        fadd.dd f10, f8, f8
        fst.d   f8, DEPTH(r2)
        fmul.dd f18, f18, f18
        pixel   0, f2
        pixel   1, f4
        fmov.dd f26, f8
        scaled  ONE
        fst.d   f0, ALONG_X(r2)
        fst.d   f0, ALONG_Y(r2)
        fst.d   f0, XY(r2)
        fld.d   S_STEP(r20), f12
        fld.d   S_STEP+8(r20), f14
        fmul.dd f12, f12, f8
        fsub.dd f0, f8, f8
        scaled  XX
        fmul.dd f14, f14, f8
        fsub.dd f0, f8, f8
        scaled  YY
        // The ellipse.
pictured: fld.d XX(r2), f16
        fld.d   S_FOUR(r20), f10
        fld.d   YY(r2), f20
        fmul.dd f10, f16, f8
        fld.d   XY(r2), f18
        fmul.dd f8, f20, f8
        fld.d   ALONG_X(r2), f22
        fmul.dd f18, f18, f12
        fld.d   ALONG_Y(r2), f24
        fsub.dd f8, f12, f8
        reciprocal
        fmul.dd f18, f24, f8
        fld.d   ONE(r2), f26
        fmul.dd f10, f20, f14
        fmul.dd f14, f22, f14
        fsub.dd f8, f14, f8
        fmul.dd f8, f12, f28
        fmul.dd f18, f22, f8
        fmul.dd f10, f16, f14
        fmul.dd f14, f24, f14
        fsub.dd f8, f14, f8
        fmul.dd f8, f12, f30
        fld.d   ORIGIN(r2), f8
        fmul.dd f22, f28, f22
        fld.d   ORIGIN+8(r2), f10
        fadd.dd f8, f28, f8
        fst.d   f8, PEAK(r2)
        fmul.dd f24, f30, f24
        fadd.dd f10, f30, f10
        fst.d   f10, PEAK+8(r2)
        fadd.dd f22, f24, f22
        fld.d   S_HALF(r20), f8
        fmul.dd f22, f8, f22
        fld.d   S_MINUS_FOUR(r20), f10
        fadd.dd f26, f22, f26
        fst.d   f26, PEAK_VALUE(r2)
        fmul.dd f10, f26, f10
        fmul.dd f10, f12, f10
        fmul.dd f10, f20, f20
        fst.d   f20, SQUARES(r2)
        fmul.dd f10, f16, f16
        fst.d   f16, SQUARES+8(r2)
        // The box of the ellipse, and the regions that the box meets.
        extent  0, r11, r12
        extent  1, r13, r14
        clipped r11, r12, lastcolumn
        firstrow r13
        lastrow r14
        clipped r13, r14, lastline
        boxed
        shr     7, r11, r11
        shr     7, r12, r12
        regionrow r13
        regionrow r14
        binned
        // The pixels of these regions.
        orh     0x4330, r0, r30
        fld.d   S_TWO52(r20), f10
        shl     7, r11, r8
        double  r8, LEFT
        shl     7, r12, r8
        adds    127, r8, r8
        double  r8, RIGHT
        toprow  r13, r9
        line    r9
        double  r9, TOP
        toprow  r14, r9
        adds    127, r9, r9
        line    r9
        double  r9, BOTTOM
        fld.d   S_ROUND(r20), f16
        nearest 0, LEFT, RIGHT, PIXEL_X
        nearest 1, TOP, BOTTOM, PIXEL_Y
        // The shifts of the values.
        ld.l    PEAK_VALUE+4(r2), r8
        fld.d   XX(r2), f16
        fld.d   XY(r2), f18
        shr     20, r8, r8
        and     0x7FF, r8, r8
        adds    -1021, r8, r8
        shra    1, r8, r8
        adds    -12, r8, r25
        clamped r25, 20
        fld.d   YY(r2), f20
        fld.d   ALONG_X(r2), f22
        fld.d   ALONG_Y(r2), f24
        fld.d   ONE(r2), f26
        fld.d   PEAK_VALUE(r2), f30
        greater LEFT, TOP
        greater LEFT, BOTTOM
        greater RIGHT, TOP
        greater RIGHT, BOTTOM
        adds    r25, r25, r9                // 2^-2 depth_shift
        mov     1023, r8
        subs    r8, r9, r9
        shl     20, r9, r8
        ixfr    r0, f8
        ixfr    r8, f9
        fmul.dd f30, f8, f8
        fxfr    f9, r8
        shr     20, r8, r8
        and     0x7FF, r8, r8
        mov     1068, r26
        subs    r26, r8, r26
        clamped r26, 24
        adds    r26, r9, r9
        shl     20, r9, r9
        ixfr    r0, f28
        ixfr    r9, f29
        // Coefficients around the pixel, then around pixel (0, 0).
        fld.d   PIXEL(r2), f8
        fld.d   ORIGIN(r2), f12
        fld.d   PIXEL+8(r2), f10
        fsub.dd f8, f12, f8
        fld.d   ORIGIN+8(r2), f12
        call    value
        fsub.dd f10, f12, f10
        fmov.dd f12, f26
        fld.d   P_TWO(r20), f12
        fld.d   S_ROUND(r20), f30
        fmul.dd f12, f16, f14
        fmul.dd f14, f8, f14
        fadd.dd f22, f14, f22
        fmul.dd f18, f10, f14
        fadd.dd f22, f14, f22
        fmul.dd f12, f20, f14
        fmul.dd f14, f10, f14
        fadd.dd f24, f14, f24
        fmul.dd f18, f8, f14
        fadd.dd f24, f14, f24
        whole   f16
        whole   f18
        whole   f20
        whole   f22
        whole   f24
        whole   f26
        fld.d   PIXEL_X(r2), f28
        fld.d   PIXEL_Y(r2), f30
        ixfr    r0, f9
        ixfr    r0, f11
        ixfr    r0, f14
        times   f16, f17, f28, f2
        times   f18, f19, f30, f4
        fiadd.dd f2, f4, f6
        fisub.dd f6, f22, f6
        fisub.dd f22, f2, f22
        fisub.dd f22, f2, f22
        fisub.dd f22, f4, f22
        times   f6, f7, f28, f2
        fiadd.dd f26, f2, f26
        times   f20, f21, f30, f2
        times   f18, f19, f28, f4
        fisub.dd f2, f24, f6
        fisub.dd f24, f2, f24
        fisub.dd f24, f2, f24
        fisub.dd f24, f4, f24
        times   f6, f7, f30, f2
        fiadd.dd f26, f2, f26
        quadraticrows
        fst.l   f16, 8(r18)
        fst.l   f17, 12(r18)
        fst.l   f18, 16(r18)
        fst.l   f19, 20(r18)
        fst.l   f20, 24(r18)
        fst.l   f21, 28(r18)
        fst.l   f22, 32(r18)
        fst.l   f23, 36(r18)
        fst.l   f24, 40(r18)
        fst.l   f25, 44(r18)
        fst.l   f26, 48(r18)
        fst.l   f27, 52(r18)
        // Depth; half a step of the root nearer if there is room.
        fld.d   FRONT(r2), f8
        ld.l    S_PARALLEL(r20), r8
        fsub.dd f0, f8, f12
        btne    r0, r8, foremost
        reciprocal
foremost: fld.d S_REACH(r20), f8
        fld.d   S_BASE(r20), f10
        fmul.dd f8, f12, f12
        fld.d   S_ROOM(r20), f8
        fadd.dd f10, f12, f12
        fsub.dd f12, f8, f12
        pfgt.dd f12, f0, f0
        bc      room
        fmov.dd f0, f12
room:   adds    1022, r25, r8
        shl     20, r8, r8
        ixfr    r0, f10
        ixfr    r8, f11
        pfgt.dd f12, f10, f0
        bnc     narrow
        fmov.dd f10, f12
narrow: fld.d   DEPTH(r2), f16
        fld.d   DEPTH+8(r2), f18
        fld.d   DEPTH+16(r2), f20
        fsub.dd f16, f12, f16
        fld.d   ORIGIN(r2), f22
        fld.d   ORIGIN+8(r2), f24
        call    plane
        adds    76, r18, r11
        restated 76
        heads   0, 1
        ld.l    S_WORDS+56(r20), r8
        shl     16, r26, r9
        ld.l    S_WORDS+72(r20), r10
        adds    r8, r9, r8
        adds    r10, r25, r10
        st.l    r8, 56(r18)
        st.l    r10, 72(r18)
        heads   15, 16
        heads   17, 22
        heads   23, 24
        ld.l    S_WORDS+100(r20), r8
        nop
        st.l    r8, 100(r18)
        surface
        adds    COMMAND_BYTES, r18, r18
drop:   adds    -1, r17, r17
        adds    SPHERE_BYTES, r16, r16
        btne    r0, r17, next
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop

// Functions that the code of spheres calls.

// ---- f18 = 1 / the root of f16. Changes f8, f20, f22.
root:   fld.d   S_HALF(r20), f20
        fld.d   S_THREE_HALVES(r20), f22
        nop
        reciprocal_root
        bri     r1
        nop

// ---- f12 = value of the conic at f8, f10 from its origin. In: coefficients in f16 to f26. Changes f14.
value:  fmul.dd f16, f8, f12
        fmul.dd f18, f10, f14
        fadd.dd f12, f14, f12
        fadd.dd f12, f22, f12
        fmul.dd f12, f8, f12
        fmul.dd f20, f10, f14
        fadd.dd f14, f24, f14
        fmul.dd f14, f10, f14
        fadd.dd f12, f14, f12
        bri     r1
        fadd.dd f12, f26, f12

// ---- plane with value f16 and slopes f18, f20 at the pixel f22, f24, stored at r11. Keeps r4, r9, r10, f22 to f26,
// f30.
plane:  fld.d   S_LIMIT(r20), f28
        fsub.dd f0, f18, f8
        pfgt.dd f28, f18, f0
        bnc     level
        pfgt.dd f28, f8, f0
        bnc     level
        fsub.dd f0, f20, f8
        pfgt.dd f28, f20, f0
        bnc     level
        pfgt.dd f28, f8, f0
        bnc     level
        fld.d   PIXEL(r2), f8
        fsub.dd f8, f22, f8
        fld.d   PIXEL+8(r2), f10
        fsub.dd f10, f24, f10
        fmul.dd f18, f8, f8
        fld.d   S_ROUND(r20), f12
        fadd.dd f16, f8, f16
        fmul.dd f20, f10, f10
        fadd.dd f16, f10, f16
        fadd.dd f18, f12, f18
        fld.d   PIXEL_X(r2), f8
        fadd.dd f20, f12, f20
        fld.d   PIXEL_Y(r2), f10
        fadd.dd f16, f12, f16
        fxfr    f18, r6
        fmlow.dd f18, f8, f8
        fxfr    f20, r7
        st.l    r6, 0(r11)
        fmlow.dd f20, f10, f10
        st.l    r7, 4(r11)
        fxfr    f8, r6
        fxfr    f10, r7
        fxfr    f16, r8
        adds    r6, r7, r6
        subs    r8, r6, r8
        bri     r1
        st.l    r8, 8(r11)
level:  fld.d   S_ROUND(r20), f12
        st.l    r0, 0(r11)
        fadd.dd f16, f12, f16
        st.l    r0, 4(r11)
        fxfr    f16, r8
        bri     r1
        st.l    r8, 8(r11)
