(expect: two-motion-words 2:5)
G00 G01 X1
