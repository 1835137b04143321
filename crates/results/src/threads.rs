//! Threads: parallel maps over the items of a list, work that its caller watches, and work behind its caller. No other
//! module of the libraries of the workspace starts threads.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender, SyncSender};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Number of threads that the machine has, for which the system is asked once: it reads several files for the answer.
static AVAILABLE: LazyLock<usize> =
    LazyLock::new(|| std::thread::available_parallelism().map_or(1, usize::from));

/// Number of threads for the items of a list: at most `threads` (`None`: as many as the machine has), and at least one.
fn thread_count<T>(threads: Option<u16>, items: &[T]) -> usize {
    threads
        .map_or_else(|| *AVAILABLE, usize::from)
        .clamp(1, items.len().max(1))
}

/// The next item with its index, for any thread that asks; `None` at the end of the list.
fn next_of<'a, T: Sync>(items: &'a [T]) -> impl Fn() -> Option<(usize, &'a T)> + Sync {
    let next = AtomicUsize::new(0);
    move || {
        let index = next.fetch_add(1, Ordering::Relaxed);
        Some((index, items.get(index)?))
    }
}

/// Evaluates `work(index, item)` for each of `items` on at most `threads` threads (`None`: as many as the machine
/// has) and returns the results in the order of the items. They do not depend on the number of threads.
///
/// ```
/// use results::threads::parallel_map;
///
/// let squares = parallel_map(&[1, 2, 3, 4], Some(2), |index, n| index * 10 + n * n);
/// assert_eq!(squares, [1, 14, 29, 46]);
/// ```
///
/// # Panics
/// If `work` panics, with its message.
pub fn parallel_map<T: Sync, R: Send>(
    items: &[T],
    threads: Option<u16>,
    work: impl Fn(usize, &T) -> R + Sync,
) -> Vec<R> {
    let threads = thread_count(threads, items);
    let next = next_of(items);
    let worker = || {
        let mut done = Vec::new();
        while let Some((index, item)) = next() {
            done.push((index, work(index, item)));
        }
        done
    };
    let made: Vec<(usize, R)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(worker)).collect();
        let mut all = worker();
        for other in others {
            match other.join() {
                Ok(done) => all.extend(done),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    });
    in_order(made)
}

/// Takes the results, in the order of the items by whose indices they are.
fn in_order<R>(mut made: Vec<(usize, R)>) -> Vec<R> {
    made.sort_by_key(|(index, _)| *index);
    made.into_iter().map(|(_, made)| made).collect()
}

/// Performs `work` on a thread of its own, and calls `watch` from the calling thread every `interval` until it is
/// done. Where `watch` decides that the work shall stop, it says so by a flag that `work` reads.
///
/// ```
/// use std::sync::atomic::{AtomicBool, Ordering};
/// use std::time::Duration;
///
/// use results::threads::watched;
///
/// let stop = AtomicBool::new(false);
/// let work = || {
///     while !stop.load(Ordering::Relaxed) {
///         std::hint::spin_loop();
///     }
///     "stopped"
/// };
/// // the work lasts until its caller has stopped it
/// let mut calls = 0;
/// let said = watched(Duration::from_millis(1), work, || {
///     calls += 1;
///     stop.store(true, Ordering::Relaxed);
/// });
/// assert!(said == "stopped" && calls > 0);
/// ```
///
/// # Panics
/// If `work` panics, with its message.
pub fn watched<R: Send>(
    interval: Duration,
    work: impl FnOnce() -> R + Send,
    mut watch: impl FnMut(),
) -> R {
    std::thread::scope(|scope| {
        let (ended, ends) = mpsc::channel::<()>();
        let worker = scope.spawn(move || {
            // dropped when the work ends, also by a panic
            let _ended = ended;
            work()
        });
        while ends.recv_timeout(interval) == Err(RecvTimeoutError::Timeout) {
            watch();
        }
        worker
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// Evaluates `work(item)` for each of `items` on `threads` threads (`None`: as many as the machine has) and passes each
/// result to `receive` on the calling thread as soon as it is there, in any order. `receive` returns whether to go on;
/// after `false` no further work begins. At most a few results wait, so that memory does not grow with the number of
/// items.
///
/// ```
/// use results::threads::parallel_stream;
///
/// let mut sum = 0;
/// parallel_stream(&[1, 2, 3, 4], Some(2), |n| n * n, |_, square| {
///     sum += square;
///     true
/// });
/// assert_eq!(sum, 30);
/// ```
///
/// # Panics
/// If `work` panics, with its message.
pub fn parallel_stream<T: Sync, R: Send>(
    items: &[T],
    threads: Option<u16>,
    work: impl Fn(&T) -> R + Sync,
    mut receive: impl FnMut(&T, R) -> bool,
) {
    let threads = thread_count(threads, items);
    let next = next_of(items);
    let (sender, receiver) = mpsc::sync_channel(2 * threads);
    let worker = |sender: SyncSender<(usize, R)>| {
        while let Some((index, item)) = next() {
            // the receiver is gone if no further results are wanted
            if sender.send((index, work(item))).is_err() {
                return;
            }
        }
    };
    let worker = &worker;
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|_| {
                let sender = sender.clone();
                scope.spawn(move || worker(sender))
            })
            .collect();
        drop(sender);
        for (index, result) in &receiver {
            if !receive(&items[index], result) {
                break;
            }
        }
        drop(receiver);
        for worker in workers {
            if let Err(panic) = worker.join() {
                std::panic::resume_unwind(panic);
            }
        }
    });
}

/// Work on other threads while the caller goes on with its own, such as files that are written to the disk.
///
/// ```
/// use results::threads::Background;
///
/// let mut squares = Background::new(2, |n: u64| n * n);
/// for n in 1..=4 {
///     squares.begin(n);
/// }
/// assert_eq!(squares.wait(), [1, 4, 9, 16]);
/// ```
///
/// A value that is dropped performs what has begun.
#[derive(Debug)]
pub struct Background<T, R> {
    work: fn(T) -> R,
    threads: u16,
    /// Number of items since the last wait.
    begun: usize,
    items: Option<Sender<(usize, T)>>,
    waiting: Arc<Mutex<Receiver<(usize, T)>>>,
    workers: Vec<JoinHandle<Vec<(usize, R)>>>,
}

impl<T: Send + 'static, R: Send + 'static> Background<T, R> {
    /// Performs `work` on at most `threads` threads, which start with the first items.
    #[must_use]
    pub fn new(threads: u16, work: fn(T) -> R) -> Background<T, R> {
        let (items, waiting) = mpsc::channel();
        let waiting = Arc::new(Mutex::new(waiting));
        Background {
            work,
            threads,
            begun: 0,
            items: Some(items),
            waiting,
            workers: Vec::new(),
        }
    }

    /// Begins the work on an item; it starts a thread until all are there.
    pub fn begin(&mut self, item: T) {
        if self.workers.len() < usize::from(self.threads.max(1)) {
            let (work, waiting) = (self.work, Arc::clone(&self.waiting));
            self.workers.push(std::thread::spawn(move || {
                let next = || {
                    waiting
                        .lock()
                        .unwrap_or_else(PoisonError::into_inner)
                        .recv()
                };
                std::iter::from_fn(|| next().ok())
                    .map(|(index, item)| (index, work(item)))
                    .collect()
            }));
        }
        let items = self.items.as_ref().expect("it is closed in a wait alone");
        items
            .send((self.begun, item))
            .expect("the receiver lives as long as this value");
        self.begun += 1;
    }

    /// Waits for all work that has begun and returns its results since the last wait, in the order of the items.
    ///
    /// # Panics
    /// If `work` panics, with its message.
    pub fn wait(&mut self) -> Vec<R> {
        let mut ended = std::mem::replace(self, Background::new(self.threads, self.work));
        ended
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

impl<T, R> Background<T, R> {
    /// Lets the threads end after the last item, and returns the results in the order of the items.
    fn join(&mut self) -> std::thread::Result<Vec<R>> {
        self.items = None;
        let mut made = Vec::with_capacity(self.begun);
        let mut result = Ok(());
        for worker in self.workers.drain(..) {
            match worker.join() {
                Ok(done) => made.extend(done),
                Err(panic) => result = Err(panic),
            }
        }
        result.map(|()| in_order(made))
    }
}

impl<T, R> Drop for Background<T, R> {
    fn drop(&mut self) {
        // a panic of a thread has been reported there, and nobody asks for its result
        let _ = self.join();
    }
}

#[cfg(test)]
mod tests {
    use super::{Background, parallel_map, parallel_stream};

    #[test]
    fn a_stream_has_every_result_once_and_ends_where_it_is_told() {
        let items: Vec<u64> = (0..100).collect();
        for threads in [Some(1), Some(3), None] {
            let mut seen = Vec::new();
            parallel_stream(
                &items,
                threads,
                |n| n * n,
                |n, square| {
                    assert_eq!(square, n * n);
                    seen.push(*n);
                    true
                },
            );
            seen.sort_unstable();
            assert_eq!(seen, items);
            let mut count = 0;
            parallel_stream(
                &items,
                threads,
                |n| *n,
                |_, _| {
                    count += 1;
                    count < 5
                },
            );
            assert_eq!(count, 5);
        }
    }

    #[test]
    fn work_behind_its_caller_is_done_once_and_can_be_waited_for_again() {
        for threads in [0, 1, 3] {
            let mut squares = Background::new(threads, |n: u64| n * n);
            assert!(squares.wait().is_empty());
            for begun in [0..100, 100..101] {
                begun.clone().for_each(|n| squares.begin(n));
                assert_eq!(squares.wait(), begun.map(|n| n * n).collect::<Vec<_>>());
            }
        }
        let mut fails = Background::new(2, |n: u64| assert_ne!(n, 3, "the third fails"));
        (0..5).for_each(|n| fails.begin(n));
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| fails.wait())).is_err());
    }

    #[test]
    fn results_keep_the_order_of_their_items_on_any_number_of_threads() {
        let items: Vec<u64> = (0..100).collect();
        for threads in [Some(0), Some(1), Some(3), None] {
            let made = parallel_map(&items, threads, |index, item| (index, item * item));
            assert_eq!(made.len(), 100);
            assert!(
                made.iter()
                    .enumerate()
                    .all(|(k, (index, square))| *index == k && *square == (k * k) as u64)
            );
        }
    }
}
