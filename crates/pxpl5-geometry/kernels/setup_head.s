// The triangle of the records at r3, r4 and r5 to the words of a command at r18.
AREA_WORD = 8
LOW_XY    = 16
HIGH_XY   = 24
SIDE_WORD = 32
ROW_WORD  = 56
TO_X      = 320
TO_Y      = 328
FROM_X    = 336
FROM_Y    = 344
TIES      = 352   // three words whose signs say which edges own their pixels
// for depth and each word of the surface: slopes before the division by the area, and value at corner 0
S_z       = 368
S_n0      = 392
S_n1      = 416
S_n2      = 440
// places of the planes in the command
AT_z      = 56
AT_n0     = 76
AT_n1     = 92
AT_n2     = 108

        .pool   r1 r8 r9 r10 r11 r12 r13 r14 r15 r26 r27 r28 r29 r30 r6
