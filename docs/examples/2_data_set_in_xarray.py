"""
A labelled data set in xarray
=============================

A grid of gears, fault classes, severities and operating points becomes one HDF5 file. It is laid out as NetCDF-4, so
that xarray reads signals and facts together.
"""

import xarray
from matplotlib.figure import Figure

import swgsim as swg

path = swg.generate("small", "clean", data="data")  # the command: swg generate grid=small condition=clean
data = xarray.open_dataset(path, engine="h5netcdf")
print(data)

# %%
# Facts lie along the dimension ``sample``: select recordings as in a table.
cracked = data.where(data.label_name == "root_tooth_crack", drop=True)
print(cracked.sizes["sample"], "recordings of a root tooth crack")

# %%
# The mean of gauge s1 over the recordings of each class, in mV/V:
s1 = data.signals.sel(sensor="s1").mean("time").groupby(data.label_name).mean()
figure = Figure(figsize=(7, 3.5), layout="constrained")
axes = figure.add_subplot()
axes.barh([str(name).replace("_", " ") for name in s1.label_name.values], s1.values, color="#0072B2")
axes.set_xlabel("mean of s1 [mV/V]")
