        // corners in doubt did not come here
doubted = or r0, r0
