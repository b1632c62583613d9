(expect: modal-conflict 3:1)
G51.1 Z0
G81 Z-5 R2 F100
