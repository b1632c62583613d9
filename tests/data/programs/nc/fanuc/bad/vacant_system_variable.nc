(expect: undefined-parameter 2:1)
#3006=#1
M30
