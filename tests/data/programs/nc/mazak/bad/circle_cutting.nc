(expect: unsupported-word 2:1)
G12 I10. D1 F100.
M30
