(expect: unsupported-word 2:1)
G150 X3.25 Y4.5 Z-1.5 G41 J.35 K.01 Q.8 R.1 P40002 D1 F15.
M30
