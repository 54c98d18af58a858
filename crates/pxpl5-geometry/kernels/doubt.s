doubt   = or doubted, flat
