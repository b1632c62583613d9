(expect: undefined-parameter 2:6)
G00 X[#5]
M30
