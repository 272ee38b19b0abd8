"""From configuration (``conf/``) to objects, data sets and virtual recordings.

``settings`` makes the objects; the commands ``swg generate`` and ``swg record`` are ``generate_data_set`` and
``record_on_bench``. The subpackage exports nothing.
"""
