// Puts the command at r18 into the bin of every region that a triangle touches, 128 pixels wide. A
// region is touched when its pixels meet the pixels of the bounding box, and every edge has a point of the region on
// its inner side.
//
// In: low x, high x, low y, high y at BOX(r2); table of bins r19;
// macro edgeword k, n, to loads coefficient n (a, b, c) of edge k.
// Out: number of regions r22. Changes r5 to r15, r23 to r31, f8 to f13.

// f12 low word = product modulo 2^32
        .macro  times a, b, to
        ixfr    \a, f8
        ixfr    \b, f10
        fmlow.dd f8, f10, f12
        fxfr    f12, \to
        .endm

// to `outside` unless the greatest value of edge k over the region is not negative
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
        bc      outside                     // 0 > the value
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
ba:     adds    -9, r25, r12                // last pixel whose centre is left of its right side
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
        shl     4, r7, r28                  // wholly inside the pixel centres of one region?
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

// every region of the box against the three edges
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
