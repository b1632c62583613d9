(expect: unknown-subprogram 2:1)
M98 P1234
