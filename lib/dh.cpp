// dh
