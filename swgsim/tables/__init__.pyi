from .file_defect import FileDefect
from .layout import Layout
from .measured_column import MeasuredColumn
from .table_map import TableMap

__all__ = ["FileDefect", "Layout", "MeasuredColumn", "TableMap"]
