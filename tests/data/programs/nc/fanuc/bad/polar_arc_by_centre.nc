(expect: unsupported-word 4:1)
G16
G00 X10 Y0
G03 X10 Y90 I-10 F100
