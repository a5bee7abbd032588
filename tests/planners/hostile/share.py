"""Use so many megabytes and share them with children for a moment; reserve far more."""

import mmap
import os
import sys
import time


def main() -> None:
    held = b"x" * (int(sys.argv[1]) << 20)
    reserved = mmap.mmap(-1, 8 << 30, prot=mmap.PROT_READ)
    for _ in range(int(sys.argv[2])):
        if os.fork() == 0:
            time.sleep(0.4)
            os._exit(0)
    while True:
        try:
            os.wait()
        except ChildProcessError:
            break
    reserved.close()
    os.write(1, b"%d bytes held\n" % len(held))


if __name__ == "__main__":
    main()
