(expect: undefined-parameter 2:6)
#100=#3001
M30
