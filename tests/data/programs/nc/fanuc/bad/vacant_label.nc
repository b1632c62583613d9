(expect: undefined-parameter 2:5)
GOTO#1
M30
