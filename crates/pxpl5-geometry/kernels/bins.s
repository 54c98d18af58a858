// Code for the regions that a command touches, in three variants: bins of regions, boxes of commands, or all regions.

.if DUAL & BINNED & !FIELD
.if GRID
// For frames of any size: computes each edge's greatest value over a region from the value over the previous region.
// Multiplications remain only for the first region and for regions that are cut off.
.else
// For frames of 640 x 480, without a multiplication: computes each edge's greatest value over a region from the value
// over the previous region.
.endif
//
// In: r24 to r27 lowest x, highest x, lowest y and highest y of the triangle, r18 command with the edges, r19 table of
// bins.
.if GRID
// Out: r22 number of regions. Changes r4 to r15, r23 to r31, f8 to f13.
.else
// Out: r22 number of regions. Changes r4 to r15, r23 to r31.
.endif

// Multiplies a and b of an edge by 128. Adds to c the greatest value over region (0, 0): the value at the right side if
// a > 0, and on the last line if b > 0.
        .macro  greatest k, a, b, c
        edgeword \k, 0, \a
        edgeword \k, 1, \b
        edgeword \k, 2, \c
        shra    31, \a, r23
        andnot  r23, \a, r23
        shl     7, r23, r28
        subs    r28, r23, r28
        adds    r28, \c, \c
        shra    31, \b, r23
        andnot  r23, \b, r23
        shl     7, r23, r28
        subs    r28, r23, r28
        adds    r28, \c, \c
        shl     7, \a, \a
        shl     7, \b, \b
        .endm

.if GRID
// Corrects c for a region that has r28 columns or lines less.
.else
// Corrects c for the last row of regions, which has 32 lines less.
.endif
        .macro  shorter b, c
        shra    31, \b, r23
        andnot  r23, \b, r23
.if GRID
        shr     7, r23, r23
        ixfr    r23, f8
        ixfr    r28, f10
        fmlow.dd f8, f10, f12
        fxfr    f12, r23
.else
        shr     2, r23, r23
.endif
        subs    \c, r23, \c
.if GRID
        .endm

// r28 = number of columns or lines that the last region lacks. In: r28 last subpixel of the picture.
        .macro  lacking
        shr     4, r28, r28
        and     127, r28, r28
        subs    127, r28, r28
.endif
        .endm

// Computes the first pixel whose centre is not before a low side, and the last pixel whose centre is before a high
// side.
        .macro  firstpixel r
        adds    7, \r, \r
        shra    4, \r, \r
        shra    31, \r, r23
        andnot  r23, \r, \r
        .endm
        .macro  lastpixel r, most
.if GRID
        ld.l    \most(r20), r29
.endif
        adds    -9, \r, \r
        shra    4, \r, \r
.if GRID
        shr     4, r29, r29
        subs    r29, \r, r23
.else
        subs    \most, \r, r23
.endif
        shra    31, r23, r28
        and     r28, r23, r23
        adds    r23, \r, \r
        .endm

        .align  32
bins:   firstpixel r24
.if GRID
        lastpixel r25, P_LAST_X
.else
        lastpixel r25, 639
.endif
        firstpixel r26
.if GRID
        lastpixel r27, P_LAST_Y
.else
        lastpixel r27, 479
.endif
        mov     r0, r22
        subs    r25, r24, r23
        subs    r27, r26, r28
        or      r23, r28, r23
        subs    r23, r0, r0
        bc      nowhere                     // no pixel, because the difference is negative
        shr     7, r24, r24
        shr     7, r25, r25
        shr     7, r26, r26
        shr     7, r27, r27
        greatest 0, r5, r8, r11
        greatest 1, r6, r9, r12
        greatest 2, r7, r10, r13
        bte     r0, r24, column             // go to the first column
        mov     r24, r29
left:   adds    -1, r29, r29
        adds    r5, r11, r11
        adds    r6, r12, r12
        adds    r7, r13, r13
        btne    r0, r29, left
column: bte     r0, r26, row                // go to the first row
        mov     r26, r29
above:  adds    -1, r29, r29
        adds    r8, r11, r11
        adds    r9, r12, r12
        adds    r10, r13, r13
        btne    r0, r29, above
.if GRID
row:    regionnumber r26, r24               // place of the first region in the table
        shl     2, r28, r31
.else
row:    shl     2, r26, r31                 // place of the first region in the table
        adds    r26, r31, r31
        adds    r24, r31, r31
        shl     2, r31, r31
.endif
        adds    r19, r31, r31
.if GRID
rows:   ld.l    P_LAST_Y(r20), r28
        nop
        shr     11, r28, r23
        btne    r23, r26, whole
        lacking
        bte     r0, r28, whole
.else
rows:   btne    3, r26, whole
.endif
        shorter r8, r11
        shorter r9, r12
        shorter r10, r13
whole:  mov     r11, r14
        mov     r12, r15
        mov     r13, r4
        mov     r31, r30
        mov     r24, r29
.if GRID
columns: ld.l   P_LAST_X(r20), r28
        nop
        shr     11, r28, r23
        btne    r23, r29, full
        lacking
        bte     r0, r28, full
        shorter r5, r14
        shorter r6, r15
        shorter r7, r4
full:   or      r14, r15, r23
.else
columns: or     r14, r15, r23
.endif
        or      r4, r23, r23
        adds    1, r29, r28
        subs    r23, r0, r0
        bc      beside                      // a value is negative
        ld.l    0(r30), r23
        adds    1, r22, r22
        st.l    r18, 0(r23)
        adds    4, r23, r23
        st.l    r23, 0(r30)
beside: bte     r25, r29, below             // after the last column
        mov     r28, r29
        adds    r5, r14, r14
        adds    r6, r15, r15
        adds    r7, r4, r4
        br      columns
        adds    4, r30, r30
below:  adds    r8, r11, r11
        adds    r9, r12, r12
        adds    r10, r13, r13
.if GRID
        ld.l    P_COLUMNS(r20), r23
        nop
        shl     2, r23, r23
        adds    r23, r31, r31
.else
        adds    20, r31, r31
.endif
        bte     r27, r26, nowhere           // after the last row
        br      rows
        adds    1, r26, r26
nowhere: bri    r1
        nop
.elseif BINNED
// Puts the command at r18 into the bin of every region (128 pixels wide) that a triangle touches. A triangle touches a
// region under two conditions: its bounding box contains pixels of the region, and each edge has a point of the region
// on its inner side.
//
// In: lowest x, highest x, lowest y, highest y at BOX(r2); r19 table of bins. The macro `edgeword k, n, to` loads
// coefficient n (a, b, c) of edge k.
// Out: r22 number of regions. Changes r5 to r15, r23 to r31, f8 to f13.

// The low word of f12 becomes the product modulo 2^32.
        .macro  times a, b, to
        ixfr    \a, f8
        ixfr    \b, f10
        fmlow.dd f8, f10, f12
        fxfr    f12, \to
        .endm

// Jumps to `outside` if the greatest value of edge k over the region is negative.
        .macro  test k
        edgeword \k, 0, r28
        edgeword \k, 1, r29
        mov     r7, r30                     // left
        subs    r0, r28, r0
        bnc     x\@
        mov     r8, r30                     // right
x\@:    mov     r9, r31                     // top
        subs    r0, r29, r0
        bnc     y\@
        mov     r10, r31                    // bottom
y\@:    times   r28, r30, r28
        times   r29, r31, r29
        edgeword \k, 2, r30
        adds    r28, r29, r28
        adds    r28, r30, r28
        subs    r28, r0, r0
        bc      outside                     // the value is negative
        .endm

        .align  32
bins:   mov     r0, r22
        ld.l    BOX(r2), r24
        ld.l    BOX+4(r2), r25
        ld.l    BOX+8(r2), r26
        ld.l    BOX+12(r2), r27
        adds    7, r24, r11                 // first pixel whose centre is not left of the box
        shra    4, r11, r11
        subs    r0, r11, r0                 // at least 0
        bc      ba
        mov     r0, r11
ba:     adds    -9, r25, r12                // last pixel whose centre is left of the box's right side
        shra    4, r12, r12
        lastcolumn r12
        adds    7, r26, r13
        shra    4, r13, r13
        firstrow r13
        subs    r0, r13, r0
        bc      bc1
        mov     r0, r13
bc1:    adds    -9, r27, r14
        shra    4, r14, r14
        lastrow r14
        lastline r14
        subs    r12, r11, r0                // empty?
        bc      return
        subs    r14, r13, r0
        bc      return
        shr     7, r11, r11                 // first and last column and row of regions
        shr     7, r12, r12
        regionrow r13
        regionrow r14
        shl     7, r11, r7
        adds    127, r7, r8
        cutoff  r8
        mov     r1, r15
        call    rowbox
        nop
        mov     r15, r1
        shl     4, r7, r28                  // inside the pixel centres of one region?
        adds    8, r28, r28
        subs    r24, r28, r0
        bc      many
        shl     4, r8, r28
        adds    8, r28, r28
        subs    r28, r25, r0
        bc      many
        shl     4, r9, r28
        adds    8, r28, r28
        subs    r26, r28, r0
        bc      many
        shl     4, r10, r28
        adds    8, r28, r28
        subs    r28, r27, r0
        bc      many
        regionnumber r13, r11
        insert  r28
return: bri     r1
        nop

// top and bottom line of the row r13 of regions
rowbox: toprow  r13, r9
        adds    LAST_OF_REGION, r9, r10
        lastline r10
        line    r9
        line    r10
        bri     r1
        nop

// Test every region of the box against the three edges.
many:   mov     r1, r15
        ixfr    r0, f9
        ixfr    r0, f11
rows:   call    rowbox
        mov     r11, r23                    // column
columns: shl    7, r23, r7
        adds    127, r7, r8
        cutoff  r8
        test    0
        test    1
        test    2
        regionnumber r13, r23
        insert  r28
outside: adds   1, r23, r23
        subs    r12, r23, r0
        bnc     columns                     // column <= last
        adds    1, r13, r13
        subs    r14, r13, r0
        bnc     rows
        bri     r15
        nop
.elseif BOXES
// For a pipeline that finds the windows of triangles later: there are no bins. The box of each command is stored at
// r19.

bins:   ld.l    BOX(r2), r24
        ld.l    BOX+4(r2), r25
        ld.l    BOX+8(r2), r26
        ld.l    BOX+12(r2), r27
        st.l    r24, 0(r19)
        st.l    r25, 4(r19)
        st.l    r26, 8(r19)
        st.l    r27, 12(r19)
        adds    16, r19, r19
        bri     r1
        mov     1, r22
.else
// For a pipeline that sends every triangle to all regions: there are no bins.

bins:   bri     r1
        mov     1, r22
.endif
