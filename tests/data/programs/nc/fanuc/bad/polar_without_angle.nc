(expect: missing-word 3:5)
G16
G00 X10
