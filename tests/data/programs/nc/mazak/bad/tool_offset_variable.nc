(expect: undefined-parameter 2:4)
#1=#10001
M30
