// One triangle after another, as a good compiler of about 1990 would give a plain program in C: functions that are called, loops that
// stay loops, locals in registers, scalar floating point with loads in its shadow. The rules were written down before the code
// (compiled_rules.md).
//
// The arithmetic and its order are those of the native transform and set-up.

// ---- stack frame, further up as in setup_scalar.s
SAVE   = 0        // return address

        .macro  secondcorner to
        adds    C_BYTES, r7, \to
        .endm

// Planes of triangles that are not clipped are taken as they come.
        .macro  steep
        .endm
