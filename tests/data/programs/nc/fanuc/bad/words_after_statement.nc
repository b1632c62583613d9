(expect: unexpected-character 2:6)
#1=2 G00 X1
