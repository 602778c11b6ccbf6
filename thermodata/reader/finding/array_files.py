"""Lines that make a Parquet file of files of named arrays (HDF5, netCDF, NumPy), which work as they are printed: with
the scales, the mark of what is missing, and the units that stand in attributes."""

from __future__ import annotations

# data sets of the commonest kind, the longest ones; f and c: the file, and its data sets by name
_HDF5 = """\
import h5py, numpy, os, pyarrow, pyarrow.parquet as p; f = h5py.File('{name}'); c = {}; \
f.visititems(lambda k, d: c.update({k: d} if getattr(d, 'ndim', 0) and d.dtype.kind in 'biufOS' else {})); \
n = max(map(len, c.values())); b = os.path.commonprefix([k[:k.rfind('/') + 1] for k in c]).rfind('/') + 1; \
g = lambda d, k, o: numpy.ravel(d.attrs.get(k, o))[0]; \
s = lambda v: v.decode() if isinstance(v, bytes) else str(v); \
u = lambda d: next((' [' + s(g(d, k, '')) + ']' for k in ('units', 'unit') if k in d.attrs), ''); \
w = lambda d: d.asstr()[:] if d.dtype.kind in 'OS' else d[:] \
if d.attrs.keys().isdisjoint(('scale_factor', 'add_offset', '_FillValue')) \
else numpy.where(d[:] == g(d, '_FillValue', numpy.nan), numpy.nan, \
d[:] * float(g(d, 'scale_factor', 1)) + float(g(d, 'add_offset', 0))); \
p.write_table(pyarrow.table({k[b:] + f'_{i}' * (d.ndim > 1) + u(d): x for k, d in c.items() if len(d) == n \
for i, x in enumerate(w(d).reshape(n, -1).T)}), '{stem}.parquet')"""
_NPZ = """\
import numpy, pyarrow, pyarrow.parquet as p; f = numpy.load('{name}'); c = {k: f[k] for k in f if f[k].ndim}; \
n = max(map(len, c.values())); p.write_table(pyarrow.table({k + f'_{i}' * (d.ndim > 1): x \
for k, d in c.items() if len(d) == n for i, x in enumerate(d.reshape(n, -1).T)}), '{stem}.parquet')"""
_NETCDF = """\
import xarray; d = xarray.open_dataset('{name}'); \
d.rename({k: k + ' [' + v.attrs['units'] + ']' for k, v in d.data_vars.items() if 'units' in v.attrs})\
.to_dataframe().reset_index().to_parquet('{stem}.parquet')"""


def _line(code: str) -> str:
    return f'make a Parquet file of it: python -c "{code}"'


BY_HDF5 = (
    f"{_line(_HDF5)}, with h5py (pip install h5py): its longest data sets, with their scales and units; what other "
    "attributes say, as when it began, is yours to declare; of one that pandas wrote: "
    "pandas.read_hdf('{name}').to_parquet('{stem}.parquet')"
)
BY_NPZ = f"{_line(_NPZ)}: its longest arrays, by their names; declare their units"
BY_XARRAY = (
    f"{_line(_NETCDF)}, with xarray (pip install xarray pandas pyarrow {{with}}), which applies scale_factor, "
    "add_offset, _FillValue and the time's units"
)
