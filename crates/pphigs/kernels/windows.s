// Finds the primitives of windows (windows_rules.md) in three functions:
//
//   windows    Computes the limits of windows.
//              In: r16 upper left pixels of the windows (upper half: row, lower half: column), r17 number of windows (at
//              least 1), r18 destination, r19 size of a window (upper half: rows, lower half: columns), r20 size of the
//              picture in the same format, r21 line of the frame that is row 0 of the picture, r22 0 if each line is a
//              row, or 1 if every second line is a row.
//   triangles  Adds each triangle to the lists of the windows that it touches.
//              In: r16 first command, r17 number of triangles (at least 1), r18 boxes of the triangles, r19 windows, r20
//              number of windows, r21 table of lists, r22 regions of the picture in the format of windows, or 0, r23
//              number of regions, r24 and r25 as r21 and r22 of `windows`, r2 stack.
//   spheres    Adds each sphere to the lists of the windows that it touches.
//              In: r16 to r21 as for triangles.
//
// The rectangle around all windows comes before the first window, in the same format. A list has the addresses of commands.
// The table of lists has the format of the table of bins in token.s. Before the search, the end of each list is its start.

W_LEFT   = 0            // limits in 1/16 px of the frame: a box touches the window if its right end is at least W_LEFT, its left end is
W_RIGHT  = 4            // at most W_RIGHT, its lower end is at least W_TOP, and its upper end is at most W_BOTTOM
W_TOP    = 8
W_BOTTOM = 12
W_FIRST_COLUMN = 16     // first and last column and row of the window's pixels
W_LAST_COLUMN = 20
W_FIRST_ROW = 24
W_LAST_ROW = 28
W_BYTES  = 32
BOX_BYTES = 16
TRIANGLE_BYTES = 120    // size of a command
SPHERE_BYTES = 212
SAVE     = 0            // stack frame: return address

// Widens the range in the words `low` and `high` of the window at r30. The new range contains the range from r26 to r27.
        .macro  widened low, high
        ld.l    \low(r30), r28
        ld.l    \high(r30), r29
        subs    r26, r28, r0
        bnc     low\@
        st.l    r26, \low(r30)
low\@:  subs    r29, r27, r0
        bnc     high\@
        st.l    r27, \high(r30)
high\@:
        .endm

        .align  32
windows: mov    r18, r30
        orh     0x7FFF, r0, r23
        subs    r0, r23, r24
        st.l    r23, W_LEFT(r30)
        st.l    r24, W_RIGHT(r30)
        st.l    r23, W_TOP(r30)
        st.l    r24, W_BOTTOM(r30)
        st.l    r23, W_FIRST_COLUMN(r30)
        st.l    r24, W_LAST_COLUMN(r30)
        st.l    r23, W_FIRST_ROW(r30)
        st.l    r24, W_LAST_ROW(r30)
        and     0xFFFF, r19, r11            // columns and rows of a window, last column and row of the picture
        shr     16, r19, r12
        and     0xFFFF, r20, r13
        shr     16, r20, r14
        adds    -1, r13, r13
        adds    -1, r14, r14
window: ld.l    0(r16), r8
        adds    W_BYTES, r18, r18
        and     0xFFFF, r8, r5
        shr     16, r8, r6
        adds    r5, r11, r7
        adds    -1, r7, r7
        subs    r13, r7, r0
        bnc     across
        mov     r13, r7
across: adds    r6, r12, r8
        adds    -1, r8, r8
        subs    r14, r8, r0
        bnc     down
        mov     r14, r8
down:   st.l    r5, W_FIRST_COLUMN(r18)
        st.l    r7, W_LAST_COLUMN(r18)
        st.l    r6, W_FIRST_ROW(r18)
        st.l    r8, W_LAST_ROW(r18)
        mov     r5, r26
        mov     r7, r27
        widened W_FIRST_COLUMN, W_LAST_COLUMN
        mov     r6, r26
        mov     r8, r27
        widened W_FIRST_ROW, W_LAST_ROW
        shl     4, r5, r26
        shl     4, r7, r27
        adds    9, r26, r26
        adds    8, r27, r27
        st.l    r26, W_LEFT(r18)
        st.l    r27, W_RIGHT(r18)
        widened W_LEFT, W_RIGHT
        bte     r0, r22, frame
        shl     1, r6, r6
        shl     1, r8, r8
frame:  adds    r21, r6, r6
        adds    r21, r8, r8
        shl     4, r6, r26
        shl     4, r8, r27
        adds    9, r26, r26
        adds    8, r27, r27
        st.l    r26, W_TOP(r18)
        st.l    r27, W_BOTTOM(r18)
        widened W_TOP, W_BOTTOM
        adds    -1, r17, r17
        adds    4, r16, r16
        btne    r0, r17, window
        bri     r1
        nop

// Computes `to` = a * b modulo 2^32. f9 and f11 must be 0.
        .macro  times a, b, to
        ixfr    \a, f8
        ixfr    \b, f10
        fmlow.dd f8, f10, f12
        fxfr    f12, \to
        .endm

// Jumps to `apart` if the greatest value of edge k within the window at r14 is negative.
        .macro  test k
        ld.l    8+16*\k(r16), r28
        ld.l    12+16*\k(r16), r29
        ld.l    W_FIRST_COLUMN(r14), r30
        subs    r0, r28, r0
        bnc     x\@
        ld.l    W_LAST_COLUMN(r14), r30
x\@:    ld.l    W_FIRST_ROW(r14), r31
        subs    r0, r29, r0
        bnc     y\@
        ld.l    W_LAST_ROW(r14), r31
y\@:    times   r28, r30, r28
        times   r29, r31, r29
        ld.l    16+16*\k(r16), r30
        adds    r28, r29, r28
        adds    r28, r30, r28
        subs    r28, r0, r0
        bc      apart                       // the value is negative
        .endm

// Sets r3 to 1 if a triangle touches the window at r14, otherwise to 0. r16 is the address of the triangle's command, and r8
// to r11 are its box. Changes r28 to r31.
meets:  ld.l    W_TOP(r14), r28
        ld.l    W_BOTTOM(r14), r29
        subs    r11, r28, r0
        bc      apart                       // the box ends above the window
        subs    r29, r10, r0
        bc      apart
        ld.l    W_LEFT(r14), r28
        ld.l    W_RIGHT(r14), r29
        subs    r9, r28, r0
        bc      apart
        subs    r29, r8, r0
        bc      apart
        test    0
        test    1
        test    2
        bri     r1
        mov     1, r3
apart:  bri     r1
        mov     r0, r3

// Jumps to `otherwise` unless the box in r8 to r11 overlaps a rectangle. The four limits of the rectangle begin at `first` of
// the window at `of`. Lines are compared before columns.
        .macro  within of, first, otherwise
        ld.l    \first+8(\of), r28
        ld.l    \first+12(\of), r29
        subs    r11, r28, r0
        bc      \otherwise
        subs    r29, r10, r0
        bc      \otherwise
        ld.l    \first(\of), r28
        ld.l    \first+4(\of), r29
        subs    r9, r28, r0
        bc      \otherwise
        subs    r29, r8, r0
        bc      \otherwise
        .endm

// Adds the command at r16 to the list whose end is stored at r12.
        .macro  entered
        ld.l    0(r12), r28
        nop
        st.l    r16, 0(r28)
        adds    4, r28, r28
        st.l    r28, 0(r12)
        .endm

        .align  32
triangles: st.l r1, SAVE(r2)
        ixfr    r0, f9
        ixfr    r0, f11
        ld.l    W_TOP(r19), r5
        ld.l    W_BOTTOM(r19), r6
triangle: ld.l  8(r18), r10
        ld.l    12(r18), r11
        subs    r6, r10, r0
        bc      beside                      // below the last line of all windows
        subs    r11, r5, r0
        bc      beside                      // above the first line of all windows
        ld.l    0(r18), r8
        ld.l    4(r18), r9
        ld.l    W_LEFT(r19), r28
        ld.l    W_RIGHT(r19), r29
        subs    r29, r8, r0
        bc      beside
        subs    r9, r28, r0
        bc      beside
        // Does the box contain the centres of a column and of a row?
        adds    7, r8, r28
        shra    4, r28, r28
        adds    -9, r9, r29
        shra    4, r29, r29
        subs    r29, r28, r0
        bc      beside
        adds    7, r10, r28
        shra    4, r28, r28
        adds    -9, r11, r29
        shra    4, r29, r29
        bte     r0, r25, rows
        subs    r28, r24, r28
        adds    1, r28, r28
        shra    1, r28, r28
        subs    r29, r24, r29
        shra    1, r29, r29
rows:   subs    r29, r28, r0
        bc      beside
        bte     r0, r22, touching
        adds    W_BYTES, r22, r14
        mov     r23, r13
region: call    meets
        adds    -1, r13, r13
        btne    r0, r3, touching
        adds    W_BYTES, r14, r14
        btne    r0, r13, region
        br      beside
        nop
touching: adds  W_BYTES, r19, r14
        mov     r20, r13
        adds    8, r21, r12
each:   call    meets
        adds    -1, r13, r13
        bte     r0, r3, other
        entered
other:  adds    W_BYTES, r14, r14
        adds    8, r12, r12
        btne    r0, r13, each
beside: adds    -1, r17, r17
        adds    BOX_BYTES, r18, r18
        adds    TRIANGLE_BYTES, r16, r16
        btne    r0, r17, triangle
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop

        .align  32
spheres: ld.l   0(r18), r8
        ld.l    4(r18), r9
        ld.l    8(r18), r10
        ld.l    12(r18), r11
        within  r19, W_FIRST_COLUMN, passed
        adds    W_BYTES, r19, r14
        mov     r20, r13
        adds    8, r21, r12
one:    within  r14, W_FIRST_COLUMN, next
        entered
next:   adds    W_BYTES, r14, r14
        adds    8, r12, r12
        adds    -1, r13, r13
        btne    r0, r13, one
passed: adds    -1, r17, r17
        adds    BOX_BYTES, r18, r18
        adds    SPHERE_BYTES, r16, r16
        btne    r0, r17, spheres
        bri     r1
        nop
