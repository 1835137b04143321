"""Writes mill.bdf again in three formats with pyNastran 1.4.1 from PyPI: python make.py"""

from pyNastran.bdf.bdf import read_bdf

model = read_bdf("mill.bdf", xref=False, validate=False, debug=None)
model.write_bdf("mill_small.bdf", size=8, is_double=False, interspersed=False)
model.write_bdf("mill_large.bdf", size=16, is_double=False, interspersed=False)
model.write_bdf("mill_double.bdf", size=16, is_double=True, interspersed=False)
