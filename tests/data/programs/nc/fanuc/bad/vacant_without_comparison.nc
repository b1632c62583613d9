(expect: undefined-parameter 2:7)
G00 X[#1+#0]
M30
