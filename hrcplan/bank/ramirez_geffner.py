def is_folder(p): return False
