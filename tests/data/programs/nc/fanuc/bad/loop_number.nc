(expect: out-of-range 2:3)
DO4
