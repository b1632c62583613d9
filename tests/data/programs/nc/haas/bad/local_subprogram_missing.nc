(expect: unknown-label 2:1)
M97 P1000
M30
