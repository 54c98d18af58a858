        // turned the way that is not drawn, too
cull_a  = ld.l P_CULL(r20)
cull_b  = xor cull_a, ad
cull_c  = ld.l P_CULL+4(r20)
culled  = and cull_c, cull_b
doubt_a = or doubted, flat
doubt   = or doubt_a, culled
