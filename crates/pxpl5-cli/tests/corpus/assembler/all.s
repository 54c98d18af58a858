size = 4 * 3
.macro add3 a, b
loop\@: adds \a, \b, \b
  bla r4, r5, loop\@
  nop
.endm
start: add3 r5, r6
.rept 3
  fld.d 8(r4)++, f8
.endr
  fadd.ss f2, f3, f4
  nop
.align 16
data: .long size, start, h%start
.byte 1, 2, -3
.align 4
.float 1.5, -2e3
.double 0.1
mov 0x12345678, r9
end: nop
